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

}  // namespace delvox
