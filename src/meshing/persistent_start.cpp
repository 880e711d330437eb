#include <algorithm>

#include "delaunay/restricted_triangles.h"
#include "delvox/core/errors.h"
#include "meshing/persistent_triangle.h"
#include "meshing/refinement.h"
#include "meshing/umbrella.h"

namespace delvox {

void Refinement::start() {
  // Cancelling ends it; a limit does not: fewer seeds would leave components without any.
  const auto go_on = [this] {
    budget_.go_on(vertex_count(), 0);
    return true;
  };
  // Where that is dense, the rest comes without Del S: fewer seeds make that smaller. With three times the size it
  // would be smaller still, but more of what follows goes wrong.
  constexpr double kDenseSpread = 2;
  const Seeds seeds = oracle_.seeds(leaves_dense_ ? scaled(surface_.size, kDenseSpread) : surface_.size, go_on);
  if (seeds.points.empty()) throw NothingToMesh("the surface is empty: no point was found on it; choose another isovalue, formula or box");
  report_.components = seeds.components;
  watch_ = LandmarkWatch(along_curve(oracle_.landmarks(surface_.size, go_on)));
  if (variant_.start == Start::kPersistent) return insert_persistent_triangles(seeds);
  if (features_) return insert_seeds_beside_features(seeds, go_on);
  delaunay_.insert_seeds(seeds.points, go_on);
  enqueue_created();
}

/// One triangle for each component: the book meshes components one by one.
void Refinement::insert_persistent_triangles(const Seeds& seeds) {
  std::vector<PersistentTriangle> of_component(seeds.components);
  for (std::size_t i = 0; i < seeds.points.size(); ++i) {
    of_component[seeds.component_of[i]].seeds.push_back(seeds.points[i]);
  }
  for (PersistentTriangle& triangle : of_component) {
    if (triangle.seeds.empty()) continue;  // a component too small for seeds of its own
    if (!choose_persistent(triangle)) throw OptionError("no persistent triangle was found; take --start seeds");
    insert_persistent(triangle);
    persistent_.push_back(std::move(triangle));
  }
}

/// On a random seed of its component, in a ball without vertices. False if there is none.
bool Refinement::choose_persistent(PersistentTriangle& triangle) {
  const double count = static_cast<double>(triangle.seeds.size());
  const Point3& x = triangle.seeds[static_cast<std::size_t>(random_.uniform() * count)];
  double size = surface_.size(x);
  for (VertexId vertex : surface_vertices()) size = std::min(size, distance(x, delaunay_.point(vertex)));
  const auto found = find_persistent_triangle(oracle_, x, size, random_);
  if (found) triangle.points = *found;
  return found.has_value();
}

/// Those of a triangle's vertices that are not there.
void Refinement::insert_persistent(PersistentTriangle& triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle.vertices[i] != kNone) continue;
    triangle.vertices[i] = insert_surface_point(triangle.points[i], delaunay_.some_cell()).value_or(kNone);
  }
  persistent_gone_ = false;
}

/// Whether refinement was stuck without so often that it is to keep its vertices.
bool Refinement::stays(const PersistentTriangle& triangle) {
  constexpr int kMostHelps = 16;
  return triangle.helped >= kMostHelps;
}

bool Refinement::delete_persistent_vertex() {
  if (budget_.exhausted()) return false;
  bool deleted = false;
  for (PersistentTriangle& triangle : persistent_) {
    if (stays(triangle)) continue;
    auto& v = triangle.vertices;
    const auto present = std::find_if(v.begin(), v.end() - 1, [](VertexId vertex) { return vertex != kNone; });
    if (present == v.end() - 1) continue;
    remove_vertex(*present);
    *present = kNone;
    deleted = true;
  }
  if (!deleted && !shapes_matter()) {
    // With the short edges gone, Quality begins (book, 14.4): every triangle is looked at again.
    persistent_gone_ = true;
    for (FacetId facet : restricted_triangles(delaunay_))
      queues_.facets.push_back({facet, delaunay_.stamp(facet.cell)});
    return true;
  }
  return deleted;
}

/// Looks for a triangle that is dual to an edge which is not bipolar (book, 14.1.3), puts deleted vertices of a
/// persistent triangle back in (14.1.2), or begins with another one: with sizes as large as the surface the first need
/// not persist.
bool Refinement::mend_inadequate() {
  bool mended = false;
  for (PersistentTriangle& triangle : persistent_) {
    const auto& v = triangle.vertices;
    if (std::any_of(v.begin(), v.end(), [this](VertexId vertex) { return has_triangle(vertex); })) continue;
    mended |= split_largest_ball_at(v) || reinsert(triangle) || replace(triangle);
  }
  return mended || (!has_any_triangle() && split_largest_ball_at(surface_vertices()));
}

bool Refinement::reinsert(PersistentTriangle& triangle) {
  const auto missing = std::count(triangle.vertices.begin(), triangle.vertices.end(), kNone);
  if (missing == 0 || stays(triangle)) return false;
  ++triangle.helped;
  report_.reinsertions += static_cast<std::size_t>(missing);
  insert_persistent(triangle);
  return true;
}

/// Vertices of the one before stay, as any others do.
bool Refinement::replace(PersistentTriangle& triangle) {
  if (stays(triangle) || !choose_persistent(triangle)) return false;
  ++triangle.helped;
  triangle.vertices = {kNone, kNone, kNone};
  insert_persistent(triangle);
  return true;
}

bool Refinement::has_triangle(VertexId vertex) const {
  return vertex != kNone && !find_umbrella(delaunay_, vertex).facets.empty();
}

std::vector<VertexId> Refinement::surface_vertices() const {
  std::vector<VertexId> vertices;
  for (VertexId v = Delaunay3::kCorners; v < delaunay_.vertex_capacity(); ++v) {
    if (delaunay_.kind(v) == VertexKind::kSurface) vertices.push_back(v);
  }
  return vertices;
}

bool Refinement::has_any_triangle() const {
  for (VertexId v = Delaunay3::kCorners; v < delaunay_.vertex_capacity(); ++v) {
    if (delaunay_.kind(v) == VertexKind::kSurface && has_triangle(v)) return true;
  }
  return false;
}

/// Inserts the centre of the largest surface ball of the facets at some vertices, whatever their edges' labels.
bool Refinement::split_largest_ball_at(std::span<const VertexId> vertices) {
  SurfaceBall largest;
  CellId hint = kNone;
  for (VertexId vertex : vertices) {
    if (vertex == kNone) continue;
    for (CellId cell : delaunay_.incident_cells(vertex)) {
      for (int i = 0; i < 4; ++i) {
        if (!delaunay_.proper({cell, i}) || has_interior_vertex({cell, i})) continue;
        for (const Point3& center : delaunay_.dual_crossings({cell, i}, oracle_)) {
          const double squared_radius =
              squared_distance(center, delaunay_.point(delaunay_.vertices(FacetId{cell, i})[0]));
          if (squared_radius <= largest.squared_radius) continue;
          largest = {center, squared_radius};
          hint = cell;
        }
      }
    }
  }
  const double smallest = surface_.min_ball_radius;
  if (hint == kNone || largest.squared_radius <= smallest * smallest || !budget_left()) return false;
  return insert_surface_point(largest.center, hint).has_value();
}

}  // namespace delvox
