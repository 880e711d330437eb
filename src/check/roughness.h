#pragma once

#include <span>
#include <vector>

#include "check/element_quality.h"

namespace delvox::check {

/// Angles between the normals of triangles that share an edge, degrees: the largest, and how many exceed the bound.
/// Edges of one triangle or of more than two do not count, nor do those `kept` (feature_checks.h).
Extreme measure_roughness(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                          const Promises& bounds, Precision precision, const std::vector<Edge>& kept);

}  // namespace delvox::check
