#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "delaunay/ids.h"
#include "delaunay/walled_region.h"
#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// Delaunay tetrahedra of a walled region that are known without inserting their points one by one. Points become
/// vertices numbered from the triangulation's vertex_capacity() on, tets cells from its cell_capacity() on.
struct KnownTets {
  struct Tet {
    std::array<VertexId, 4> vertices;  ///< in positive order
    std::array<CellId, 4> neighbors;   ///< kNone beyond a wall
    Label label = 0;                   ///< of the circumcentre
  };
  std::vector<Point3> points;
  std::vector<Wall> walls;
  std::vector<FacetId> inside;  ///< for each wall, that facet of the tet at it
  std::size_t count = 0;
  std::function<Tet(std::size_t)> tet;  ///< of `count`; asked by several threads
};

}  // namespace delvox
