#include "meshing/umbrella.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/parallel.h"
#include "delaunay/restricted_triangles.h"

namespace delvox {
namespace {

using LinkEdge = std::array<VertexId, 2>;

/// Do the edges form exactly one cycle?
bool is_one_cycle(std::span<const LinkEdge> edges) {
  if (edges.empty()) return true;
  // Both directions of each edge, sorted by their first end: in a cycle every vertex comes up exactly twice.
  thread_local std::vector<LinkEdge> half_edges;
  half_edges.clear();
  for (const LinkEdge& e : edges) {
    half_edges.push_back(e);
    half_edges.push_back({e[1], e[0]});
  }
  std::sort(half_edges.begin(), half_edges.end());
  for (std::size_t i = 0; i < half_edges.size(); i += 2) {
    if (half_edges[i][0] != half_edges[i + 1][0]) return false;
    if (i + 2 < half_edges.size() && half_edges[i + 2][0] == half_edges[i][0]) return false;
  }
  const auto others = [&](VertexId v) {
    return std::lower_bound(half_edges.begin(), half_edges.end(), LinkEdge{v, 0});
  };
  VertexId previous = edges[0][0], current = edges[0][1];
  std::size_t length = 1;
  while (current != edges[0][0]) {
    const auto pair = others(current);
    const VertexId next = (*pair)[1] != previous ? (*pair)[1] : (*(pair + 1))[1];
    previous = current;
    current = next;
    if (++length > edges.size()) return false;
  }
  return length == edges.size();
}

/// The link edges of all vertices, vertex after vertex.
class Links {
 public:
  explicit Links(const RestrictedDelaunay& delaunay) : first_(delaunay.vertex_capacity() + 1, 0) {
    std::vector<std::array<VertexId, 3>> triangles;
    for (FacetId facet : restricted_triangles(delaunay)) triangles.push_back(delaunay.vertices(facet));
    for (const auto& triangle : triangles) {
      for (VertexId v : triangle) ++first_[v + 1];
    }
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    edges_.resize(3 * triangles.size());
    for (const auto& t : triangles) {
      for (int i = 0; i < 3; ++i) edges_[next[t[i]]++] = {t[(i + 1) % 3], t[(i + 2) % 3]};
    }
  }

  std::span<const LinkEdge> of(VertexId vertex) const {
    return {edges_.data() + first_[vertex], edges_.data() + first_[vertex + 1]};
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<LinkEdge> edges_;
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
      link.push_back({corners[(own + 1) % 3], corners[(own + 2) % 3]});
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
