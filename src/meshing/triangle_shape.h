#pragma once

#include <algorithm>

#include "delvox/core/geometry.h"

namespace delvox {

struct TriangleShape {
  double shortest_squared_edge = 0;
  double squared_circumradius = 0;  ///< infinite if the corners are collinear
};

inline TriangleShape triangle_shape(const Point3& a, const Point3& b, const Point3& c) {
  const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
  const double four_squared_areas = squared_norm(cross(b - a, c - a));
  return {std::min({ab, bc, ca}), ab * bc * ca / (4 * four_squared_areas)};
}

struct Circumcircle {
  Point3 center;
  double squared_radius = 0;  ///< not finite if the corners are collinear
  Vector3 normal;             ///< of the triangle's plane; not of unit length
};

inline Circumcircle circumcircle(const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 u = b - a, v = c - a, n = cross(u, v);
  const Vector3 offset = (0.5 / squared_norm(n)) * (squared_norm(u) * cross(v, n) + squared_norm(v) * cross(n, u));
  return {a + offset, squared_norm(offset), n};
}

}  // namespace delvox
