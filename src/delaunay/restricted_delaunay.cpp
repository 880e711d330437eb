#include "delaunay/restricted_delaunay.h"

#include <algorithm>

#include "delaunay/spatial_order.h"

namespace delvox {

RestrictedDelaunay::RestrictedDelaunay(const Oracle& oracle) : oracle_(oracle), delaunay_(oracle.bounds()) {
  kinds_.assign(Delaunay3::kCorners, VertexKind::kCorner);
  for (CellId cell = 0; cell < delaunay_.cell_capacity(); ++cell) describe(cell);
}

const std::vector<CellId>& RestrictedDelaunay::incident_cells(VertexId vertex) const {
  delaunay_.find_incident_cells(vertex, around_);
  return around_;
}

void RestrictedDelaunay::set_kind(VertexId vertex, VertexKind kind) {
  if (vertex >= kinds_.size()) kinds_.resize(vertex + 1);
  kinds_[vertex] = kind;
}

void RestrictedDelaunay::insert_seeds(const std::vector<Point3>& seeds, const GoOn& go_on) {
  created_.assign(1, delaunay_.cell_of(0));
  for (std::uint32_t i : spatial_order(seeds)) {
    go_on();
    delaunay_.evaluate(seeds[i], delaunay_.nearest_hint(seeds[i], created_), star_);
    if (star_.duplicate) continue;
    set_kind(delaunay_.commit(star_, created_), VertexKind::kSurface);
  }
  created_.clear();
  for (CellId cell = Delaunay3::kOutside + 1; cell < delaunay_.cell_capacity(); ++cell) {
    describe(cell);
    if (stamp(cell) != 0) created_.push_back(cell);
  }
}

std::vector<VertexId> RestrictedDelaunay::insert_interior(const std::vector<Point3>& points, const GoOn& go_on) {
  std::vector<VertexId> vertices(points.size(), kNone);
  const std::uint32_t first_stamp = delaunay_.next_stamp();
  created_.assign(1, delaunay_.cell_of(0));
  for (std::uint32_t i : spatial_order(points)) {
    if (!go_on()) break;
    delaunay_.evaluate(points[i], delaunay_.nearest_hint(points[i], created_), star_);
    vertices[i] = commit_unlabelled(VertexKind::kInterior);
  }
  created_.clear();
  for (CellId cell = 0; cell < cell_capacity(); ++cell) {
    if (stamp(cell) < first_stamp) continue;
    describe(cell);
    created_.push_back(cell);
  }
  for (CellId cell : created_) {
    for (int i = 0; i < 4 && balls_.any(cell); ++i) {
      if (!bipolar({cell, i})) drop_ball({cell, i});
    }
  }
  return vertices;
}

Label RestrictedDelaunay::label_of(const std::array<VertexId, 4>& vertices, const Circumsphere& sphere) const {
  const bool corner = std::any_of(vertices.begin(), vertices.end(), [](VertexId v) { return v < Delaunay3::kCorners; });
  return corner ? 0 : oracle_.label(sphere.center);
}

void RestrictedDelaunay::describe(CellId cell) {
  if (cell >= labels_.size()) labels_.resize(cell + 1);
  balls_.grow_to(cell + 1);
  labels_[cell] = cell == Delaunay3::kOutside ? 0 : label_of(vertices(cell), sphere(cell));
}

Point3 RestrictedDelaunay::dual_crossing(const Point3& center_a, Label label_a, const Point3& center_b,
                                         Label label_b) const {
  return label_a < label_b ? oracle_.intersect(center_a, center_b) : oracle_.intersect(center_b, center_a);
}

const SurfaceBall& RestrictedDelaunay::compute_ball(FacetId facet) {
  const FacetId other = mirror(facet);
  SurfaceBall ball;
  ball.center =
      dual_crossing(sphere(facet.cell).center, label(facet.cell), sphere(other.cell).center, label(other.cell));
  ball.squared_radius = squared_distance(ball.center, point(vertices(facet)[0]));
  const std::uint32_t number = balls_.add(ball);
  balls_.set(facet, number);
  balls_.set(other, number);
  return balls_[number];
}

void RestrictedDelaunay::drop_ball(FacetId facet) {
  const std::uint32_t number = balls_.number_of(facet);
  if (number == kNone) return;
  balls_.free(number);
  balls_.set(facet, kNone);
  balls_.set(mirror(facet), kNone);
}

const Star& RestrictedDelaunay::evaluate(const Point3& p, CellId hint) {
  delaunay_.evaluate(p, hint, star_);
  for (Star::Tet& tet : star_.tets) {
    const auto& v = tet.vertices;
    tet.label = label_of({v[0], v[0], v[1], v[2]}, tet.sphere);
  }
  return star_;
}

VertexId RestrictedDelaunay::commit(VertexKind kind) {
  // A ball on the zone's boundary stays if its centre is still on the shortened dual edge, that is, not in the Voronoi
  // cell of the new vertex, and the edge still bipolar.
  for (const Star::Tet& tet : star_.tets) {
    const SurfaceBall* kept = ball(tet.outer);
    if (kept == nullptr) continue;
    const bool covered = squared_distance(kept->center, star_.apex) < kept->squared_radius;
    if (covered || label(tet.outer.cell) == tet.label) drop_ball(tet.outer);
  }
  const VertexId vertex = commit_unlabelled(kind);
  labels_.resize(std::max(labels_.size(), cell_capacity()));
  for (std::size_t i = 0; i < created_.size(); ++i) labels_[created_[i]] = star_.tets[i].label;
  return vertex;
}

/// Balls inside the zone go, those on its boundary pass to the new cells.
VertexId RestrictedDelaunay::commit_unlabelled(VertexKind kind) {
  for (CellId cell : star_.zone) {
    if (!balls_.any(cell)) continue;
    for (int i = 0; i < 4; ++i) {
      if (delaunay_.in_zone(neighbors(cell)[i])) drop_ball({cell, i});
    }
    balls_.forget(cell);
  }
  const VertexId vertex = delaunay_.commit(star_, created_);
  set_kind(vertex, kind);
  balls_.grow_to(cell_capacity());
  for (std::size_t i = 0; i < created_.size(); ++i) {
    balls_.set({created_[i], 0}, balls_.number_of(star_.tets[i].outer));
  }
  return vertex;
}

void RestrictedDelaunay::remove(VertexId vertex) {
  for (CellId cell : incident_cells(vertex)) {
    for (int i = 0; i < 4; ++i) drop_ball({cell, i});
  }
  delaunay_.remove(vertex, destroyed_, created_);
  set_kind(vertex, VertexKind::kRemoved);
  for (CellId cell : created_) describe(cell);
}

}  // namespace delvox
