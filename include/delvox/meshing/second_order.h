#pragma once

#include <cstddef>

#include "delvox/core/mesh.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What make_second_order did with the mid-side nodes of the boundary.
struct SecondOrderReport {
  std::size_t boundary_edges = 0;
  std::size_t on_surface = 0;                  ///< of these, nodes put on the oracle's surface
  std::size_t not_found = 0;                   ///< no surface within reach of the edge's middle: left there
  std::size_t straightened = 0;                ///< put back to the middle, because a tet would have turned inside out
  Point3 where_not_found, where_straightened;  ///< one of those
};

/// Gives every tet its six mid-side nodes, appended to the points. Those of boundary edges go along the mean normal to
/// the oracle's surface, where it is within 0.3 edge lengths; all others lie in the middle. Where that would make the
/// Jacobian determinant of a tet, at its ten nodes or at its four Gauss points, smaller than a fiftieth of that of the
/// straight tet, its most curved edges are straightened. Without an oracle all edges are straight.
/// pre: first order, tets positive, oracle in the frame of the mesh. Throws OptionError: more nodes than 32 bits
/// number.
SecondOrderReport make_second_order(TetMesh& mesh, const Oracle* oracle);

/// Takes the mid-side nodes out again: corners, tets and the rest stay, points that only mid-side nodes used go.
void make_first_order(TetMesh& mesh);

}  // namespace delvox
