#pragma once

#include "delvox/core/geometry.h"

namespace delvox {

/// Circumcentre and squared circumradius of a tetrahedron.
struct Circumsphere {
  Point3 center;
  double squared_radius = 0;
};

/// The rounding error of a determinant of three vectors is below 1e-15 times the product of their lengths: where it
/// exceeds that by six orders of magnitude, a quotient by it keeps nine digits. Of squares.
inline constexpr double kSafeRatio = 1e-9 * 1e-9 * 1e6;

/// The circumsphere of tet abcd, right to about nine digits whatever its shape: computed in double where the volume is
/// clearly not zero, else in rational arithmetic and rounded. pre: the four points are not coplanar.
Circumsphere circumsphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

}  // namespace delvox
