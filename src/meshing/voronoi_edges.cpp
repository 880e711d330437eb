#include <algorithm>
#include <span>

#include "meshing/refinement.h"

namespace delvox {
namespace {

bool far_apart(std::span<const Point3> crossings, double bound) {
  for (std::size_t i = 1; i < crossings.size(); ++i) {
    if (squared_distance(crossings[i - 1], crossings[i]) > bound * bound) return true;
  }
  return false;
}

/// So many insertions for each vertex of the surface, as it was when its topology was first looked at, may look closer.
constexpr double kMostGrowth = 0.2;

}  // namespace

/// VorEdge (book, 14.2.1) on the edges of cells with a stamp from `first_new` on: the topological ball property allows
/// a Voronoi edge one crossing. One that makes an excursion to the other side and back is a neck that the mesh cuts, or
/// a gap that it bridges. As in the book, the crossing farthest from the vertices goes in; it is half an excursion away
/// from them, so that this ends if excursions shorter than a bound are left alone, as they must be: trilinear surfaces
/// have creases at the faces of voxels, along which Voronoi edges of any mesh make some.
bool Refinement::repair_voronoi_edges(std::uint32_t first_new) {
  const bool grown = expected_topology_ && closer_insertions_ > kMostGrowth * vertices_at_first_look_;
  if (grown) return false;
  std::vector<MisplacedCell> misplaced;
  next_stamp_after_edges_ = delaunay_.next_stamp();
  for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay_.cell_capacity(); ++cell) {
    const std::uint32_t stamp = delaunay_.stamp(cell);
    if (stamp == 0 || stamp < first_new) continue;
    for (int i = 0; i < 4; ++i) {
      const CellId neighbor = delaunay_.neighbors(cell)[i];
      const bool met_from_there = delaunay_.stamp(neighbor) >= first_new && neighbor < cell;
      if (met_from_there || neighbor == RestrictedDelaunay::kBeyond) continue;
      if (const auto p = crossing_of_excursion({cell, i})) misplaced.push_back({*p, cell, stamp});
    }
  }
  const std::size_t before = report_.topology_insertions;
  const bool inserted = insert_where_misplaced(misplaced);
  if (expected_topology_) closer_insertions_ += report_.topology_insertions - before;
  return inserted;
}

/// If the dual edge leaves its side for a while: its crossing farthest from the facet's vertices.
std::optional<Point3> Refinement::crossing_of_excursion(FacetId facet) const {
  const auto vertices = delaunay_.vertices(facet);
  const bool on_surface = std::all_of(vertices.begin(), vertices.end(),
                                      [this](VertexId v) { return delaunay_.kind(v) == VertexKind::kSurface; });
  if (!on_surface) return std::nullopt;
  const CellId neighbor = delaunay_.neighbors(facet.cell)[facet.index];
  const auto crossings = oracle_.intersect_all(delaunay_.sphere(facet.cell).center, delaunay_.sphere(neighbor).center);
  if (crossings.size() < 2) return std::nullopt;
  if (!far_apart(crossings, shortest_excursion_ * surface_.size(crossings[0]))) return std::nullopt;
  const Point3& corner = delaunay_.point(vertices[0]);
  return *std::max_element(crossings.begin(), crossings.end(), [&](const Point3& p, const Point3& q) {
    return squared_distance(p, corner) < squared_distance(q, corner);
  });
}

/// With all that is looked at in order: if the oracle counts another topology, looks at shorter excursions too, as long
/// as that takes few vertices.
bool Refinement::look_closer() {
  // Among interior vertices the shortest take many insertions and find little.
  const double shortest_of_all = tet_criteria_ != nullptr ? 0.02 : 0.001;
  if (!surface_.size.constant()) return false;  // where the mesh is coarse it may differ
  if (!expected_topology_) {
    expected_topology_ = oracle_.topology();
    vertices_at_first_look_ = vertex_count();
  }
  if (!expected_topology_ || topology() == *expected_topology_) return false;
  while (shortest_excursion_ > shortest_of_all) {
    shortest_excursion_ /= 2;
    if (repair_voronoi_edges(0)) return true;
  }
  return false;
}

/// Of the surface as it is. pre: every umbrella is a disk.
SurfaceTopology Refinement::topology() const {
  std::size_t triangles = 0, vertices = 0;
  std::vector<bool> met(delaunay_.vertex_capacity(), false);
  for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay_.cell_capacity(); ++cell) {
    if (delaunay_.stamp(cell) == 0) continue;
    for (int i = 0; i < 4; ++i) {
      if (delaunay_.label(cell) <= delaunay_.label(delaunay_.neighbors(cell)[i])) continue;
      ++triangles;
      for (VertexId v : delaunay_.vertices(FacetId{cell, i})) {
        vertices += !met[v];
        met[v] = true;
      }
    }
  }
  // A closed surface has three edges for every two triangles; between pieces that form a tree there is one less.
  return {find_pieces(delaunay_).count - 1, static_cast<long>(vertices) - static_cast<long>(triangles / 2)};
}

}  // namespace delvox
