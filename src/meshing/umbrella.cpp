#include "meshing/umbrella.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "core/page_array.h"
#include "core/parallel.h"
#include "delaunay/restricted_triangles.h"

namespace delvox {
namespace {

using LinkEdge = std::array<VertexId, 2>;

/// The edge of a triangle that lies opposite a corner, directed as the triangle is.
LinkEdge opposite(const std::array<VertexId, 3>& triangle, int corner) {
  return {triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]};
}

/// Do the edges, each directed as its triangle is, form exactly one cycle? There are few: looking through all for the
/// next is faster than sorting them.
bool is_one_cycle(std::span<const LinkEdge> edges) {
  if (edges.empty()) return true;
  VertexId current = edges[0][0];
  std::size_t length = 0;
  do {
    const LinkEdge* next = nullptr;
    for (const LinkEdge& edge : edges) {
      if (edge[0] != current) continue;
      if (next != nullptr) return false;
      next = &edge;
    }
    if (next == nullptr || ++length > edges.size()) return false;
    current = (*next)[1];
  } while (current != edges[0][0]);
  return length == edges.size();
}

/// The link edges of all vertices, vertex after vertex; those of one vertex in any order.
class Links {
 public:
  explicit Links(const RestrictedDelaunay& delaunay) : first_(delaunay.vertex_capacity() + 1, 0) {
    constexpr std::size_t kChunk = 1 << 12;
    using Corners = std::array<VertexId, 3>;
    const auto triangles = gather_chunks<Corners>(
        delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, std::vector<Corners>& found) {
          for_each_restricted_triangle(delaunay, begin, end,
                                       [&](FacetId facet) { found.push_back(delaunay.vertices(facet)); });
        });
    const auto for_each_corner = [&](const auto& visit) {
      for_each_chunk(triangles.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          for (int corner = 0; corner < 3; ++corner) visit(triangles[i], corner);
        }
      });
    };
    const auto count_one = [](std::uint32_t& counter) {
      return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
    };
    for_each_corner([&](const Corners& triangle, int corner) { count_one(first_[triangle[corner] + 1]); });
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    edges_.grow_to(first_.back());
    for_each_corner([&](const Corners& triangle, int corner) {
      edges_[count_one(next[triangle[corner]])] = opposite(triangle, corner);
    });
  }

  std::span<const LinkEdge> of(VertexId vertex) const {
    const std::size_t count = first_[vertex + 1] - first_[vertex];
    return count == 0 ? std::span<const LinkEdge>() : std::span(&edges_[first_[vertex]], count);
  }

 private:
  std::vector<std::uint32_t> first_;
  PageArray<LinkEdge> edges_;
};

}  // namespace

Umbrella find_umbrella(const RestrictedDelaunay& delaunay, VertexId vertex) {
  Umbrella umbrella;
  std::vector<LinkEdge> link;
  for (CellId cell : delaunay.incident_cells(vertex)) {
    for (int i = 0; i < 4; ++i) {
      const CellId neighbor = delaunay.neighbors(cell)[i];
      // Each facet is met from both of its cells: take it from the one with the larger label.
      if (delaunay.label(cell) <= delaunay.label(neighbor)) continue;
      const auto corners = delaunay.vertices(FacetId{cell, i});
      const auto own = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
      if (own == 3) continue;
      umbrella.facets.push_back({cell, i});
      link.push_back(opposite(corners, static_cast<int>(own)));
    }
  }
  umbrella.disk = is_one_cycle(link);
  return umbrella;
}

std::vector<VertexId> without_disk(const RestrictedDelaunay& delaunay, const std::vector<VertexId>& vertices) {
  constexpr std::size_t kSweepPays = 16;  // a sweep costs about as much as walking around a vertex in sixteen
  constexpr std::size_t kChunk = 256;
  const auto select = [&](const auto& disk) {
    return gather_chunks<VertexId>(vertices.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!disk(vertices[i])) found.push_back(vertices[i]);
      }
    });
  };
  if (vertices.size() * kSweepPays < delaunay.vertex_capacity()) {
    return select([&](VertexId v) { return find_umbrella(delaunay, v).disk; });
  }
  const Links links(delaunay);
  return select([&](VertexId v) { return is_one_cycle(links.of(v)); });
}

}  // namespace delvox
