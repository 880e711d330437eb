#pragma once

#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// The restricted triangles around a vertex.
struct Umbrella {
  std::vector<FacetId> facets;  ///< each once
  bool disk = true;             ///< they are none, or form one topological disk (book, figure 14.4)
};

/// T_p of the book's TopoDisk(p).
Umbrella find_umbrella(const RestrictedDelaunay& delaunay, VertexId vertex);

/// Those of the vertices whose umbrella is no disk, in their order: for many vertices, all umbrellas are gathered in
/// one sweep over the cells, at a fraction of what walking around each would cost. pre: every restricted triangle has
/// its surface ball.
std::vector<VertexId> without_disk(const RestrictedDelaunay& delaunay, const std::vector<VertexId>& vertices);

}  // namespace delvox
