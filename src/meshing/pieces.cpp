#include "meshing/pieces.h"

#include <algorithm>

#include "core/parallel.h"

namespace delvox {

Pieces::Pieces(const RestrictedDelaunay& delaunay) : joined_(delaunay.cell_capacity()) {
  constexpr CellId kFirst = RestrictedDelaunay::kBeyond + 1;
  constexpr CellId kAhead = 8;
  constexpr std::size_t kChunk = 1 << 13;
  for_each_chunk(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (auto cell = std::max(static_cast<CellId>(begin), kFirst); cell < end; ++cell) {
      if (cell + kAhead < end && delaunay.stamp(cell + kAhead) != 0) {
        delaunay.prefetch_labels_around(cell + kAhead);
        for (CellId next : delaunay.neighbors(cell + kAhead)) joined_.prefetch(next);
      }
      if (delaunay.stamp(cell) == 0) continue;
      for (CellId next : delaunay.neighbors(cell)) {
        if (next > cell && delaunay.label(next) == delaunay.label(cell)) joined_.join(cell, next);
      }
    }
  });
  const auto collect_roots = [&](std::size_t begin, std::size_t end, std::vector<CellId>& roots) {
    for (auto cell = std::max(static_cast<CellId>(begin), kFirst); cell < end; ++cell) {
      if (delaunay.stamp(cell) != 0 && joined_.root(cell) == cell) roots.push_back(cell);
    }
  };
  for (CellId root : gather_chunks<CellId>(delaunay.cell_capacity(), kChunk, collect_roots)) numbers_[root] = count_++;
}

}  // namespace delvox
