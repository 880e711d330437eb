#pragma once

#include <vector>

#include "check/element_quality.h"
#include "check/surface_topology.h"

namespace delvox::check {

/// The checks of tets with mid-side nodes.
struct SecondOrderQuality {
  Tally not_shared;  ///< edges that two tets give different nodes, nodes that two edges share, corners as mid nodes
  Extreme jacobian;  ///< least determinant at nodes and Gauss points, over the greatest there; violations: not positive
  std::vector<std::uint32_t> on_boundary;  ///< mid-side nodes of boundary edges, rising
};

/// Of each tet the least determinant of the Jacobian at nodes, Gauss points and centroid over the greatest; -1 if none
/// is positive. pre: indices valid, mid_nodes as many as tets.
std::vector<double> jacobian_ratios(const TetMesh& mesh);

/// pre: as above.
SecondOrderQuality measure_second_order(const TetMesh& mesh);

}  // namespace delvox::check
