#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <span>

#include "core/parallel.h"
#include "core/union_find.h"
#include "delaunay/restricted_triangles.h"
#include "meshing/refinement.h"

namespace delvox {
namespace {

bool far_apart(std::span<const Point3> crossings, double bound) {
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    if (squared_distance(crossings[i - 1], crossings[i]) > bound * bound) return true;
  }
  return false;
}

/// Cuts the dual edge from a to b down to what is within `reach` of the vertices that it is the dual edge of, `vertex`
/// among them; false if that is nothing.
bool clip_to_reach(Point3& a, Point3& b, const Point3& vertex, double reach) {
  const Vector3 ab = b - a, from = a - vertex;
  // |from + t ab|^2 = reach^2
  const double squared = squared_norm(ab), half = dot(from, ab), rest = squared_norm(from) - reach * reach;
  const double discriminant = half * half - squared * rest;
  if (!(discriminant > 0)) return false;
  const double root = std::sqrt(discriminant), enter = (-half - root) / squared, leave = (-half + root) / squared;
  if (enter >= 1 || leave <= 0) return false;
  const Point3 start = a;
  if (leave < 1) b = start + leave * ab;
  if (enter > 0) a = start + enter * ab;
  return true;
}

/// So many insertions for each vertex of the surface, as it was when its topology was first looked at, may look closer.
constexpr double kMostGrowth = 0.2;

}  // namespace

/// VorEdge (book, 14.2.1): the topological ball property allows a Voronoi edge one crossing. One that makes an excursion
/// to the other side and back is a neck that the mesh cuts, or a gap that it bridges. As in the book, the crossing
/// farthest from the vertices goes in; it is half an excursion away from them, so that this ends if excursions shorter
/// than a bound are left alone, as they must be: trilinear surfaces have creases at the faces of voxels, along which
/// Voronoi edges of any mesh make some.
///
/// Looks at all edges the first time, and `again`; else at those of new vertices: insertions only shorten the others.
bool Refinement::repair_voronoi_edges(bool again) {
  if (looks_closer_ && closer_insertions_ > kMostGrowth * static_cast<double>(vertices_at_first_look_)) return false;
  std::vector<VertexId> changed;
  changed.swap(since_edges_);
  const bool all = again || !edges_looked_at_;
  edges_looked_at_ = true;
  const std::size_t before = report_.topology_insertions;
  const bool inserted = insert_where_misplaced(all ? excursions_of_all() : excursions_at(std::move(changed)));
  if (looks_closer_) closer_insertions_ += report_.topology_insertions - before;
  return inserted;
}

std::vector<Refinement::MisplacedCell> Refinement::excursions_of_all() const {
  constexpr std::size_t kChunk = 4096;
  constexpr CellId kAhead = 4;
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<MisplacedCell>& misplaced) {
    const Oracle& oracle = *delaunay_.worker().oracle;
    for (auto cell = std::max(static_cast<CellId>(begin), RestrictedDelaunay::kBeyond + 1); cell < end; ++cell) {
      if (cell + kAhead < end && delaunay_.stamp(cell + kAhead) != 0) delaunay_.prefetch_neighbors(cell + kAhead);
      if (delaunay_.stamp(cell) != 0) add_excursions(cell, kNone, oracle, misplaced);
    }
  };
  return gather_chunks<MisplacedCell>(delaunay_.cell_capacity(), kChunk, collect);
}

std::vector<Refinement::MisplacedCell> Refinement::excursions_at(std::vector<VertexId> vertices) const {
  constexpr std::size_t kChunk = 64;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<MisplacedCell>& misplaced) {
    const Oracle& oracle = *delaunay_.worker().oracle;
    for (std::size_t v = begin; v < end; ++v) {
      if (delaunay_.kind(vertices[v]) != VertexKind::kSurface) continue;
      for (CellId cell : delaunay_.incident_cells(vertices[v])) add_excursions(cell, vertices[v], oracle, misplaced);
    }
  };
  return gather_chunks<MisplacedCell>(vertices.size(), kChunk, collect);
}

/// Those of the edges dual to the cell's facets, or to its facets at a vertex. Each edge is looked at from the lower of
/// its two cells.
void Refinement::add_excursions(CellId cell, VertexId at, const Oracle& oracle,
                                std::vector<MisplacedCell>& misplaced) const {
  for (int i = 0; i < 4; ++i) {
    if (delaunay_.neighbors(cell)[i] < cell || delaunay_.vertices(cell)[i] == at) continue;
    if (const auto p = crossing_of_excursion({cell, i}, oracle)) {
      misplaced.push_back({*p, cell, delaunay_.stamp(cell)});
    }
  }
}

/// If the dual edge leaves its side for a while: its crossing farthest from the facet's vertices.
std::optional<Point3> Refinement::crossing_of_excursion(FacetId facet, const Oracle& oracle) const {
  const auto vertices = delaunay_.vertices(facet);
  const bool on_surface = std::all_of(vertices.begin(), vertices.end(),
                                      [this](VertexId v) { return delaunay_.kind(v) == VertexKind::kSurface; });
  if (!on_surface) return std::nullopt;
  const CellId neighbor = delaunay_.neighbors(facet.cell)[facet.index];
  const Circumsphere &at_a = delaunay_.sphere(facet.cell), &at_b = delaunay_.sphere(neighbor);
  const double shortest = shortest_excursion_ * surface_.size.minimum();
  if (squared_distance(at_a.center, at_b.center) <= shortest * shortest) return std::nullopt;
  // Every voxel that the surface runs through has an edge that it crosses, and there are seeds within two sizes of
  // that.
  const double reach = 2 * watch_.longest_link() + 2 * surface_.size.maximum();
  const Point3& corner = delaunay_.point(vertices[0]);
  Point3 a = at_a.center, b = at_b.center;
  const bool far = std::max(at_a.squared_radius, at_b.squared_radius) > reach * reach;
  if (far && !clip_to_reach(a, b, corner, reach)) return std::nullopt;
  const auto crossings = oracle.intersect_all(a, b);
  if (crossings.size() < 2) return std::nullopt;
  if (!far_apart(crossings, shortest_excursion_ * surface_.size(crossings[0]))) return std::nullopt;
  return *std::max_element(crossings.begin(), crossings.end(), [&](const Point3& p, const Point3& q) {
    return squared_distance(p, corner) < squared_distance(q, corner);
  });
}

/// With all that is looked at in order: if the oracle counts another topology, looks at shorter excursions too, as long
/// as that takes few vertices.
bool Refinement::look_closer() {
  constexpr double kShortestOfAll = 0.001;
  if (!surface_.size.constant() || !budget_left()) return false;  // where the mesh is coarse it may differ
  if (!looks_closer_) {
    looks_closer_ = true;
    expected_topology_ = oracle_.topology();
    vertices_at_first_look_ = vertex_count();
  }
  if (!expected_topology_ || topology() == *expected_topology_) return false;
  while (shortest_excursion_ > kShortestOfAll) {
    shortest_excursion_ /= 2;
    if (repair_voronoi_edges(true)) return true;
  }
  return false;
}

/// Of the surface as it is. pre: every umbrella is a disk, and every triangle has its ball.
SurfaceTopology Refinement::topology() {
  if (topology_ && topology_from_ == delaunay_.next_stamp()) return *topology_;
  topology_from_ = delaunay_.next_stamp();
  topology_ = count_topology();
  return *topology_;
}

SurfaceTopology Refinement::count_topology() const {
  constexpr std::size_t kChunk = 1 << 14;
  UnionFind components(delaunay_.vertex_capacity());
  std::vector<std::uint8_t> met(delaunay_.vertex_capacity(), 0);
  const auto counts = map_chunks(delaunay_.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::size_t triangles = 0;
    for_each_triangle_with_ball(delaunay_, begin, end, [&](FacetId facet) {
      const auto corners = delaunay_.vertices(facet);
      for (VertexId v : corners) std::atomic_ref(met[v]).store(1, std::memory_order_relaxed);
      components.join(corners[0], corners[1]);
      components.join(corners[0], corners[2]);
      ++triangles;
    });
    return triangles;
  });
  const auto vertices = static_cast<std::size_t>(std::count(met.begin(), met.end(), 1));
  const std::size_t triangles = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  const std::size_t elsewhere = delaunay_.vertex_capacity() - vertices;  // each a set of its own
  // A closed surface has three edges for every two triangles.
  return {components.set_count() - elsewhere, static_cast<long>(vertices) - static_cast<long>(triangles / 2)};
}

}  // namespace delvox
