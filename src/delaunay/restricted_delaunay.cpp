#include "delaunay/restricted_delaunay.h"

#include <algorithm>
#include <cmath>

#include "delaunay/delaunay3.h"
#include "delaunay/spatial_order.h"
#include "delvox/core/mesh.h"

namespace delvox {

struct RestrictedDelaunay::Kernel : Delaunay3 {
  using Delaunay3::Delaunay3;
};

RestrictedDelaunay::RestrictedDelaunay(const Oracle& oracle)
    : oracle_(oracle), kernel_(std::make_unique<Kernel>(oracle.bounds())) {
  for (VertexId v = 0; v < kernel_->vertex_capacity(); ++v) name_vertex(v, kernel_->point(v), VertexKind::kCorner);
  // Below this radius the rounding of a circumcentre, which grows with its coordinates, is no longer far below the
  // filter's margin.
  const Box3 bounds = oracle.bounds();
  const double smallest_trusted = std::max(1e-6 * bounds.diagonal(), 1e-8 * (norm(bounds.min) + norm(bounds.max)));
  trusted_squared_radius_ = smallest_trusted * smallest_trusted;
}

RestrictedDelaunay::~RestrictedDelaunay() = default;

std::size_t RestrictedDelaunay::vertex_count() const { return kernel_->vertex_count() - 4; }
const std::array<CellId, 4>& RestrictedDelaunay::neighbors(CellId cell) const { return kernel_->neighbors(cell); }
const std::array<VertexId, 4>& RestrictedDelaunay::vertices(CellId cell) const { return kernel_->vertices(cell); }
FacetId RestrictedDelaunay::mirror(FacetId facet) const { return kernel_->mirror(facet); }
CellId RestrictedDelaunay::locate(const Point3& p, CellId hint) const { return kernel_->locate(p, hint); }

std::array<VertexId, 3> RestrictedDelaunay::vertices(FacetId facet) const {
  const auto& corners = kTetFaces[facet.index];
  const auto& v = kernel_->vertices(facet.cell);
  return {v[corners[0]], v[corners[1]], v[corners[2]]};
}

const std::vector<CellId>& RestrictedDelaunay::incident_cells(VertexId vertex) const {
  epoch_ += 2;
  around_.assign(1, kernel_->cell_of(vertex));
  cells_[around_.front()].visited = epoch_;
  for (std::size_t next = 0; next < around_.size(); ++next) {
    const auto& v = kernel_->vertices(around_[next]);
    const auto n = kernel_->neighbors(around_[next]);
    for (int i = 0; i < 4; ++i) {
      if (v[i] == vertex || cells_[n[i]].visited == epoch_) continue;
      cells_[n[i]].visited = epoch_;
      around_.push_back(n[i]);
    }
  }
  return around_;
}

void RestrictedDelaunay::name_vertex(VertexId vertex, const Point3& p, VertexKind kind) {
  if (vertex >= points_.size()) {
    points_.resize(vertex + 1);
    kinds_.resize(vertex + 1);
  }
  points_[vertex] = p;
  kinds_[vertex] = kind;
}

void RestrictedDelaunay::ensure_cell(CellId cell) {
  if (cell >= cells_.size()) cells_.resize(cell + 1);
}

void RestrictedDelaunay::insert_seeds(const std::vector<Point3>& seeds) {
  for (const Point3& p : in_spatial_order(seeds)) name_vertex(kernel_->insert_unnamed(p), p, VertexKind::kSurface);
  kernel_->name_all_cells();
  balls_.clear();
  free_balls_.clear();
  created_.clear();
  for (CellId cell = 0; cell < kernel_->cell_capacity(); ++cell) {
    describe_cell(cell);
    created_.push_back(cell);
  }
}

void RestrictedDelaunay::describe_cell(CellId cell) {
  ensure_cell(cell);
  Cell& data = cells_[cell];
  data = Cell{};
  data.stamp = next_stamp_++;
  if (!kernel_->finite(cell)) return;
  const auto& v = vertices(cell);
  data.sphere = circumsphere(points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]);
  data.label = oracle_.label(data.sphere.center);
}

bool RestrictedDelaunay::bipolar(FacetId facet) const {
  return cells_[facet.cell].label != cells_[kernel_->neighbors(facet.cell)[facet.index]].label;
}

const SurfaceBall* RestrictedDelaunay::ball(FacetId facet) const {
  const std::int32_t index = cells_[facet.cell].balls[facet.index];
  return index < 0 ? nullptr : &balls_[index];
}

Point3 RestrictedDelaunay::dual_crossing(const Point3& center_a, Label label_a, const Point3& center_b,
                                         Label label_b) const {
  return label_a < label_b ? oracle_.intersect(center_a, center_b) : oracle_.intersect(center_b, center_a);
}

const SurfaceBall& RestrictedDelaunay::compute_ball(FacetId facet) {
  const Cell& cell = cells_[facet.cell];
  const Cell& other = cells_[mirror(facet).cell];
  SurfaceBall ball;
  ball.center = dual_crossing(cell.sphere.center, cell.label, other.sphere.center, other.label);
  ball.squared_radius = squared_distance(ball.center, points_[vertices(facet)[0]]);
  std::int32_t index;
  if (free_balls_.empty()) {
    index = static_cast<std::int32_t>(balls_.size());
    balls_.push_back(ball);
  } else {
    index = free_balls_.back();
    free_balls_.pop_back();
    balls_[index] = ball;
  }
  set_ball(facet, index);
  set_ball(mirror(facet), index);
  return balls_[index];
}

void RestrictedDelaunay::set_ball(FacetId facet, std::int32_t ball) { cells_[facet.cell].balls[facet.index] = ball; }

void RestrictedDelaunay::drop_ball(FacetId facet) {
  const std::int32_t index = cells_[facet.cell].balls[facet.index];
  if (index < 0) return;
  free_balls_.push_back(index);
  set_ball(facet, -1);
  set_ball(mirror(facet), -1);
}

void RestrictedDelaunay::drop_balls_of(CellId cell) {
  for (int i = 0; i < 4; ++i) drop_ball({cell, i});
}

bool RestrictedDelaunay::in_conflict(CellId cell, const Point3& p) const {
  const Circumsphere& sphere = cells_[cell].sphere;
  if (sphere.squared_radius > trusted_squared_radius_) {
    // The cached sphere decides unless p is near it: circumsphere() keeps nine digits, the margin asks for six.
    const double squared = squared_distance(p, sphere.center);
    const double margin = 1e-6 * (squared + sphere.squared_radius);
    if (squared < sphere.squared_radius - margin) return true;
    if (squared > sphere.squared_radius + margin) return false;
  }
  return kernel_->in_conflict(cell, p);
}

void RestrictedDelaunay::find_zone(const Point3& p, CellId start) {
  star_.apex = p;
  star_.duplicate = false;
  star_.zone.clear();
  star_.tets.clear();
  inner_facets_.clear();
  if (!in_conflict(start, p)) start = kernel_->locate(p, start);
  if (kernel_->is_vertex_of(start, p)) {
    star_.duplicate = true;
    return;
  }
  // Two marks per search: even epochs for cells in conflict, odd ones for cells found not to be.
  epoch_ += 2;
  cells_[start].visited = epoch_;
  star_.zone.push_back(start);
  for (std::size_t next = 0; next < star_.zone.size(); ++next) {
    const CellId cell = star_.zone[next];
    for (int i = 0; i < 4; ++i) {
      const CellId neighbor = kernel_->neighbors(cell)[i];
      if (cells_[neighbor].visited != epoch_ && cells_[neighbor].visited != epoch_ + 1) {
        const bool conflict = in_conflict(neighbor, p);
        cells_[neighbor].visited = conflict ? epoch_ : epoch_ + 1;
        if (conflict) star_.zone.push_back(neighbor);
      }
      if (cells_[neighbor].visited != epoch_) inner_facets_.push_back({cell, i});
    }
  }
}

Star::Tet RestrictedDelaunay::make_star_tet(FacetId inner) const {
  Star::Tet tet;
  tet.outer = mirror(inner);
  tet.vertices = vertices(inner);
  tet.sphere =
      circumsphere(star_.apex, points_[tet.vertices[0]], points_[tet.vertices[1]], points_[tet.vertices[2]]);
  tet.label = oracle_.label(tet.sphere.center);
  return tet;
}

const Star& RestrictedDelaunay::evaluate(const Point3& p, CellId hint) {
  find_zone(p, hint);
  if (star_.duplicate) return star_;
  for (const FacetId& inner : inner_facets_) star_.tets.push_back(make_star_tet(inner));
  return star_;
}

VertexId RestrictedDelaunay::commit(VertexKind kind) {
  // A ball on the zone's boundary stays if its centre is still on the shortened dual edge, that is, not in the Voronoi
  // cell of the new vertex, and the edge still bipolar.
  for (std::size_t i = 0; i < star_.tets.size(); ++i) {
    const SurfaceBall* kept = ball(inner_facets_[i]);
    if (kept == nullptr) continue;
    const bool covered = squared_distance(kept->center, star_.apex) < kept->squared_radius;
    if (covered || cells_[star_.tets[i].outer.cell].label == star_.tets[i].label) drop_ball(inner_facets_[i]);
  }
  for (CellId cell : star_.zone) {
    for (int i = 0; i < 4; ++i) {
      if (cells_[kernel_->neighbors(cell)[i]].visited == epoch_) drop_ball({cell, i});
    }
    cells_[cell].stamp = 0;
  }
  const VertexId vertex = kernel_->insert_in_hole(star_.apex, star_.zone, inner_facets_, created_);
  name_vertex(vertex, star_.apex, kind);
  for (std::size_t i = 0; i < created_.size(); ++i) {
    const Star::Tet& tet = star_.tets[i];
    ensure_cell(created_[i]);
    cells_[created_[i]] = {tet.sphere, tet.label, next_stamp_++};
    const std::int32_t kept = cells_[tet.outer.cell].balls[tet.outer.index];
    if (kept >= 0) set_ball(mirror(tet.outer), kept);
  }
  return vertex;
}

void RestrictedDelaunay::remove(VertexId vertex) {
  for (CellId cell : incident_cells(vertex)) {
    drop_balls_of(cell);
    cells_[cell].stamp = 0;
  }
  kernel_->remove(vertex, destroyed_, created_);
  for (CellId cell : created_) describe_cell(cell);
}

}  // namespace delvox
