#pragma once

#include <algorithm>
#include <array>
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

/// As above, where every restricted triangle has its ball: few cells have any, and no others need be looked at. These
/// are found first, without branches, as which they are cannot be foreseen, so that what is asked of them can be asked
/// ahead.
template <class Visit>
void for_each_triangle_with_ball(const RestrictedDelaunay& delaunay, std::size_t begin, std::size_t end,
                                 const Visit& visit) {
  constexpr std::size_t kSome = 1 << 10, kCells = 16, kLabels = 8;
  std::array<CellId, kSome> cells;
  for (std::size_t first = begin; first < end; first += kSome) {
    std::size_t count = 0;
    for (auto cell = static_cast<CellId>(first); cell < std::min(first + kSome, end); ++cell) {
      cells[count] = cell;
      count += static_cast<std::size_t>(delaunay.has_balls(cell)) & static_cast<std::size_t>(delaunay.label(cell) != 0);
    }
    for (std::size_t n = 0; n < count; ++n) {
      if (n + kCells < count) delaunay.prefetch(cells[n + kCells]);
      if (n + kLabels < count) delaunay.prefetch_labels_around(cells[n + kLabels]);
      const Label label = delaunay.label(cells[n]);
      for (int i = 0; i < 4; ++i) {
        if (label > delaunay.label(delaunay.neighbors(cells[n])[i])) visit(FacetId{cells[n], i});
      }
    }
  }
}

/// All restricted triangles, each from the side of the larger label, in the order of the cells there.
std::vector<FacetId> restricted_triangles(const RestrictedDelaunay& delaunay);

}  // namespace delvox
