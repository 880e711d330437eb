#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// Connected pieces of cells of one label, across facets.
struct Pieces {
  std::vector<std::uint32_t> of_cell;  ///< piece of each cell, kNone for numbers not in use
  std::uint32_t count = 0;
};

Pieces find_pieces(const RestrictedDelaunay& delaunay);

}  // namespace delvox
