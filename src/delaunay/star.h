#pragma once

#include <array>
#include <cstdint>

#include "delaunay/circumsphere.h"
#include "delaunay/ids.h"
#include "delaunay/scratch.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// The tetrahedra that inserting a point would make, known before anything is changed.
struct Star {
  struct Tet {
    FacetId outer;                        ///< facet of the cell that will be its neighbour opposite the apex
    std::array<VertexId, 3> vertices;     ///< the other three; (apex, vertices) is positive
    std::array<std::uint32_t, 3> beside;  ///< the star's tets opposite them
    Label label = 0;                      ///< of the circumcentre, once labelled
    Circumsphere sphere;
  };
  /// A vertex on the zone's boundary, and one of the tets at it.
  struct Corner {
    VertexId vertex;
    std::uint32_t tet;
  };
  Point3 apex;
  bool duplicate = false;    ///< the apex is a vertex already; zone, tets and corners are empty
  Scratch<CellId> zone;  ///< cells whose circumsphere contains the apex
  Scratch<Tet> tets;
  Scratch<Corner> corners;  ///< each once

  /// To the end, without branches: where the cell is cannot be foreseen.
  bool in_zone(CellId cell) const {
    std::uint32_t found = 0;
    for (CellId known : zone) found |= known == cell;
    return found != 0;
  }
};

}  // namespace delvox
