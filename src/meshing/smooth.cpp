#include <algorithm>
#include <array>
#include <utility>

#include "delaunay/restricted_triangles.h"
#include "meshing/refinement.h"
#include "meshing/roughness.h"
#include "meshing/umbrella.h"

namespace delvox {
namespace {

/// Two neighbouring corners of an umbrella's vertex, and the facet that they form with it.
struct Side {
  VertexId corner;
  FacetId facet;
};

/// The edges between an umbrella's vertex and its neighbours, as pairs of sides with the same corner. Edges of more or
/// fewer than two triangles are TopoDisk's.
std::vector<std::array<FacetId, 2>> edges_at(const RestrictedDelaunay& delaunay, VertexId vertex) {
  std::vector<Side> sides;
  for (FacetId facet : find_umbrella(delaunay, vertex).facets) {
    for (VertexId corner : delaunay.vertices(facet)) {
      if (corner != vertex) sides.push_back({corner, facet});
    }
  }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.corner < b.corner; });
  std::vector<std::array<FacetId, 2>> edges;
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    last = first;
    while (last < sides.size() && sides[last].corner == sides[first].corner) ++last;
    if (last - first == 2) edges.push_back({sides[first].facet, sides[first + 1].facet});
  }
  return edges;
}

/// Facets face outward, as umbrellas and restricted_triangles() have them.
double roughness_degrees(const RestrictedDelaunay& delaunay, FacetId one, FacetId other) {
  const auto normal = [&](FacetId facet) {
    const auto v = delaunay.vertices(facet);
    return normal_of(delaunay.point(v[0]), delaunay.point(v[1]), delaunay.point(v[2]));
  };
  return delvox::roughness_degrees(normal(one), normal(other));
}

}  // namespace

bool Refinement::smooth() {
  if (!wants_smooth()) return false;
  bool inserted = false;
  std::vector<VertexId> round;
  round.swap(since_smooth_);
  std::sort(round.begin(), round.end());
  round.erase(std::unique(round.begin(), round.end()), round.end());
  for (VertexId vertex : round) {
    while (const auto facet = facet_to_smooth(vertex)) {
      if (!budget_left()) return inserted;
      if (!insert_surface_point(delaunay_.ball(*facet)->center, facet->cell)) break;
      inserted = true;
      ++report_.smooth_insertions;
      refine();  // step 2; step 3 follows once the round is over
    }
  }
  return inserted;
}

/// Of the two triangles at the first edge of the vertex that is too rough, the one with the larger ball; none if there
/// is no such edge, or it must be left at the smallest ball radius.
std::optional<FacetId> Refinement::facet_to_smooth(VertexId vertex) const {
  if (delaunay_.kind(vertex) != VertexKind::kSurface) return std::nullopt;
  const double smallest = surface_.min_smooth_radius * surface_.min_smooth_radius;
  const double bound = surface_.max_roughness_degrees * (1 - 1e-9);  // so that what is written still holds
  for (const auto& [one, other] : edges_at(delaunay_, vertex)) {
    const SurfaceBall *a = delaunay_.ball(one), *b = delaunay_.ball(other);
    if (a == nullptr || b == nullptr) continue;  // the budget has left it unjudged
    if (std::max(a->squared_radius, b->squared_radius) <= smallest) continue;
    if (roughness_degrees(delaunay_, one, other) <= bound || kept_edge(one, other)) continue;
    return a->squared_radius < b->squared_radius ? other : one;
  }
  return std::nullopt;
}

/// Counts the edges that are too rough in the end.
void Refinement::report_roughness() {
  if (!(surface_.max_roughness_degrees < 180) || budget_.exhausted()) return;
  std::size_t count = 0;
  Point3 where;
  std::vector<std::uint8_t> met(delaunay_.vertex_capacity(), 0);
  for (FacetId facet : restricted_triangles(delaunay_)) {
    for (VertexId vertex : delaunay_.vertices(facet)) {
      if (std::exchange(met[vertex], 1) != 0) continue;
      for (const auto& [one, other] : edges_at(delaunay_, vertex)) {
        if (roughness_degrees(delaunay_, one, other) <= surface_.max_roughness_degrees || kept_edge(one, other)) continue;
        ++count;
        where = delaunay_.point(vertex);
      }
    }
  }
  if (count == 0) return;
  const char* reason =
      effort_.hopeless() ? "not looked at, as the topology was given up" : "not met at the smallest ball radius";
  report_.unmet.push_back({"roughness", count / 2, where, reason, false});  // each edge was met from both ends
}

}  // namespace delvox
