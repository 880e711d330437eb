#pragma once

#include "delvox/core/geometry.h"

namespace delvox {

/// Exactly the sign of the volume of abcd: 1 positive, 0 coplanar, -1 negative.
int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Exactly whether p lies inside the circumsphere of abcd. Cospherical points are decided by a symbolic perturbation
/// that depends on the five points alone, not on their order or number: Delaunay triangulations are unique (Devillers
/// and Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations", 2011).
/// pre: orientation(a, b, c, d) > 0.
bool in_sphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& p);

}  // namespace delvox
