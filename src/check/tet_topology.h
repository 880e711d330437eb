#pragma once

#include <vector>

#include "check/surface_topology.h"

namespace delvox::check {

/// How tets hang together. pre: indices valid.
struct TetTopology {
  Tally crowded_faces;    ///< faces of more than two tets
  Tally folded_faces;     ///< faces whose two tets lie on the same side, by their vertex order
  Tally duplicate_tets;
  std::size_t components = 0;       ///< joined by shared faces
  std::vector<Triangle> boundary;   ///< faces of one tet, outward by its vertex order, in the order of the tets
  std::vector<Triangle> interfaces;  ///< faces between two tets of different regions
};

TetTopology tet_topology(const TetMesh& mesh);

/// Faces of one tet that `mesh.boundary` misses or turns round, and triangles it lists that bound nothing.
Tally boundary_list_faults(const TetMesh& mesh, const TetTopology& topology);

}  // namespace delvox::check
