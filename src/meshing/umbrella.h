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

}  // namespace delvox
