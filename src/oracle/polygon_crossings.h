#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// Pairs of triangles that meet elsewhere than in the vertices and edges they share.
struct CrossingTriangles {
  std::size_t pairs = 0;
  std::array<std::uint32_t, 2> first{};  ///< the least of the pairs
  Point3 where;                          ///< near the place where these meet
};

/// By exact predicates. pre: no triangle is without area.
CrossingTriangles find_crossing_triangles(const std::vector<Point3>& points, const std::vector<Triangle>& triangles);

/// Whether the corners of a triangle lie in one line, exactly.
bool has_no_area(const Point3& a, const Point3& b, const Point3& c);

}  // namespace delvox
