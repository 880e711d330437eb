#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// Connected pieces of cells of one label, across facets.
struct Pieces {
  std::vector<std::uint32_t> of_cell;  ///< piece of each cell, kNone for numbers not in use
  std::uint32_t count = 0;
  std::uint32_t reached = 0;           ///< pieces below this number hold a cell of `starts`, the others none
};

Pieces find_pieces(const RestrictedDelaunay& delaunay, const std::vector<CellId>& starts);

}  // namespace delvox
