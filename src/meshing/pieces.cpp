#include "meshing/pieces.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/union_find.h"

namespace delvox {

Pieces find_pieces(const RestrictedDelaunay& delaunay) {
  constexpr CellId kFirst = RestrictedDelaunay::kBeyond + 1;
  constexpr std::size_t kChunk = 1 << 13;
  UnionFind joined(delaunay.cell_capacity());
  for_each_chunk(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (auto cell = std::max(static_cast<CellId>(begin), kFirst); cell < end; ++cell) {
      if (delaunay.stamp(cell) == 0) continue;
      for (CellId next : delaunay.neighbors(cell)) {
        if (next > cell && delaunay.label(next) == delaunay.label(cell)) joined.join(cell, next);
      }
    }
  });
  Pieces pieces{std::vector<std::uint32_t>(delaunay.cell_capacity(), kNone), 0};
  for (CellId cell = kFirst; cell < delaunay.cell_capacity(); ++cell) {
    if (delaunay.stamp(cell) == 0) continue;
    const std::uint32_t first = joined.root(cell);  // the lowest of its piece
    pieces.of_cell[cell] = first == cell ? pieces.count++ : pieces.of_cell[first];
  }
  return pieces;
}

}  // namespace delvox
