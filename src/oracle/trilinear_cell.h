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

}  // namespace delvox
