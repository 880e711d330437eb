#pragma once

#include "delvox/core/geometry.h"

namespace delvox::check {

/// Sign of (b - a) x (c - a) . (d - a), exact for the doubles as they are: +1 for a positive tet, 0 for a flat one.
/// A forward error bound settles nearly all; the rest goes to integers of any length. pre: finite.
/// Source: Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates (1997), the
/// bound of stage A.
int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Sign of (b - a) x (c - a) in the plane of axes `u` and `v`, exact likewise.
int planar_orientation(const Point3& a, const Point3& b, const Point3& c, int u, int v);

/// Of a tet, for those so flat that rounding leaves nothing of a quotient by their volume; infinity if it has none.
double exact_circumradius(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

}  // namespace delvox::check
