#pragma once

#include <span>

#include "check/surface_topology.h"

namespace delvox::check {

/// Pairs of triangles that meet elsewhere than in a vertex or edge they share, by exact predicates. Overlap of
/// coplanar triangles is found where they share an edge; otherwise it is left to their neighbours, which cross then.
/// With positive tets and a manifold boundary, none means that no two tets overlap.
Tally crossing_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles);

}  // namespace delvox::check
