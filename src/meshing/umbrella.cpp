#include "meshing/umbrella.h"

#include <algorithm>
#include <array>

namespace delvox {
namespace {

using LinkEdge = std::array<VertexId, 2>;

/// Do the edges form exactly one cycle?
bool is_one_cycle(std::vector<LinkEdge> edges) {
  if (edges.empty()) return true;
  // Both directions of each edge, sorted by their first end: in a cycle every vertex comes up exactly twice.
  std::vector<LinkEdge> half_edges;
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

}  // namespace delvox
