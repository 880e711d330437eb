#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Critical points of the trilinear function of eight samples (bit 0 of the index along x) strictly inside the unit
/// cell: none, one or two saddles.
std::vector<Point3> body_saddles(const std::array<float, 8>& samples);

/// The saddle of the bilinear function of four samples (a at (0,0), b at (1,0), c at (1,1), d at (0,1)), if it lies
/// strictly inside the unit square.
std::optional<std::array<double, 2>> face_saddle(double a, double b, double c, double d);

/// What a trilinear function is along a line inside its cell: c[0] + c[1] t + c[2] t^2 + c[3] t^3.
struct Cubic {
  std::array<double, 4> c;

  double operator()(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
  double slope(double t) const { return c[1] + t * (2 * c[2] + t * 3 * c[3]); }
  /// A root between low and high, to rounding. pre: 0 <= low < high <= 1, the signs there differ (0 counts as below 0).
  double root_between(double low, double high) const;
};

/// Along p + t d of the trilinear function of eight samples (bit 0 of the index along x) less `level`.
Cubic cubic_along(const std::array<float, 8>& samples, double level, const Point3& p, const Vector3& d);

}  // namespace delvox
