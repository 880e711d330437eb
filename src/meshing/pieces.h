#pragma once

#include <cstdint>

#include "core/flat_hash.h"
#include "core/union_find.h"
#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// Connected pieces of cells of one label, across facets.
class Pieces {
 public:
  explicit Pieces(const RestrictedDelaunay& delaunay);

  std::uint32_t count() const { return count_; }
  /// pre: the cell is in use.
  std::uint32_t of(CellId cell) { return numbers_.find(joined_.root(cell)); }

 private:
  UnionFind joined_;
  FlatHash numbers_;  // of each piece, by its lowest cell
  std::uint32_t count_ = 0;
};

}  // namespace delvox
