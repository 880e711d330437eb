#include "delaunay/restricted_triangles.h"

#include "core/parallel.h"

namespace delvox {

std::vector<FacetId> restricted_triangles(const RestrictedDelaunay& delaunay) {
  constexpr std::size_t kChunk = 1 << 14;
  return gather_chunks<FacetId>(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    for_each_restricted_triangle(delaunay, begin, end, [&](FacetId facet) { found.push_back(facet); });
  });
}

}  // namespace delvox
