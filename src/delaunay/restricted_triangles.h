#pragma once

#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// visit(facet) for each restricted triangle of the cells from `begin` to `end`, from the side of the larger label.
template <class Visit>
void for_each_restricted_triangle(const RestrictedDelaunay& delaunay, std::size_t begin, std::size_t end,
                                  const Visit& visit) {
  constexpr CellId kAhead = 8;
  for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
    if (cell + kAhead < end && delaunay.label(cell + kAhead) != 0) delaunay.prefetch_labels_around(cell + kAhead);
    if (delaunay.stamp(cell) == 0 || delaunay.label(cell) == 0) continue;
    for (int i = 0; i < 4; ++i) {
      if (delaunay.label(cell) > delaunay.label(delaunay.neighbors(cell)[i])) visit(FacetId{cell, i});
    }
  }
}

/// All restricted triangles, each from the side of the larger label, in the order of the cells there.
std::vector<FacetId> restricted_triangles(const RestrictedDelaunay& delaunay);

}  // namespace delvox
