#include "delaunay/restricted_triangles.h"

#include "core/parallel.h"

namespace delvox {

std::vector<FacetId> restricted_triangles(const RestrictedDelaunay& delaunay) {
  constexpr std::size_t kChunk = 1 << 14;
  return gather_chunks<FacetId>(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
      if (delaunay.stamp(cell) == 0 || delaunay.label(cell) == 0) continue;
      for (int i = 0; i < 4; ++i) {
        if (delaunay.label(cell) > delaunay.label(delaunay.neighbors(cell)[i])) found.push_back({cell, i});
      }
    }
  });
}

}  // namespace delvox
