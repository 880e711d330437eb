#include "delaunay/restricted_delaunay.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "delaunay/spatial_order.h"

namespace delvox {

RestrictedDelaunay::RestrictedDelaunay(const Oracle& oracle)
    : oracle_(oracle), workers_([&oracle] { return Worker(oracle.clone()); }), delaunay_(oracle.bounds()) {
  kinds_.assign(Delaunay3::kCorners, VertexKind::kCorner);
  describe_since(0);
}

const std::vector<CellId>& RestrictedDelaunay::incident_cells(VertexId vertex) const {
  Worker& own = worker();
  delaunay_.find_incident_cells(vertex, own.around, own.search.met);
  return own.around;
}

std::vector<VertexId> RestrictedDelaunay::insert_seeds(const std::vector<Point3>& seeds, const GoOn& go_on) {
  const auto heedless = [&go_on] {
    go_on();
    return true;
  };
  std::vector<VertexId> vertices = insert_all(seeds, VertexKind::kSurface, heedless);
  created_ = describe_since(0);
  return vertices;
}

std::vector<VertexId> RestrictedDelaunay::insert_interior(const std::vector<Point3>& points, const GoOn& go_on) {
  const std::uint32_t first_stamp = delaunay_.next_stamp();
  std::vector<VertexId> vertices = insert_all(points, VertexKind::kInterior, go_on);
  created_ = describe_since(first_stamp);
  for (FacetId facet : balls_without_crossing(created_)) lose_ball(facet, lane_);
  give_back_room();
  return vertices;
}

/// Of facets of these cells that have a ball though they are not bipolar.
std::vector<FacetId> RestrictedDelaunay::balls_without_crossing(const std::vector<CellId>& cells) const {
  constexpr std::size_t kChunk = 4096;
  return gather_chunks<FacetId>(cells.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    for (std::size_t n = begin; n < end; ++n) {
      for (int i = 0; i < 4 && balls_.any(cells[n]); ++i) {
        const FacetId facet{cells[n], i};
        if (ball(facet) != nullptr && !bipolar(facet)) found.push_back(facet);
      }
    }
  });
}

Label RestrictedDelaunay::label_of(const std::array<VertexId, 4>& vertices, const Circumsphere& sphere,
                                   const Oracle& oracle) const {
  const bool corner = std::any_of(vertices.begin(), vertices.end(), [](VertexId v) { return v < Delaunay3::kCorners; });
  return corner ? 0 : oracle.label(sphere.center);
}

/// To as many cells and vertices as the triangulation has numbers for.
void RestrictedDelaunay::grow() {
  labels_.grow_to(cell_capacity());
  balls_.grow_to(cell_capacity());
  if (vertex_capacity() > kinds_.size()) kinds_.resize(vertex_capacity(), VertexKind::kRemoved);
}

void RestrictedDelaunay::set_label(CellId cell, Label label) {
  if (label < 0 || label > kLargestLabel) throw std::out_of_range("an oracle's label is not in 0 to kLargestLabel");
  labels_[cell] = static_cast<std::uint16_t>(label);
}

void RestrictedDelaunay::describe(CellId cell, const Oracle& oracle) {
  set_label(cell, cell == Delaunay3::kOutside ? 0 : label_of(vertices(cell), sphere(cell), oracle));
}

/// Describes the cells with that stamp or a greater one; they are returned in order.
std::vector<CellId> RestrictedDelaunay::describe_since(std::uint32_t first_stamp) {
  constexpr std::size_t kChunk = 4096;
  grow();
  return gather_chunks<CellId>(cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    const Oracle& oracle = *worker().oracle;
    for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
      if (cell == Delaunay3::kOutside || stamp(cell) == 0 || stamp(cell) < first_stamp) continue;
      describe(cell, oracle);
      found.push_back(cell);
    }
  });
}

SurfaceBall RestrictedDelaunay::find_ball(FacetId facet, const Oracle& oracle) const {
  const CellId other = neighbors(facet.cell)[facet.index];
  const Point3 center =
      dual_crossing(sphere(facet.cell).center, label(facet.cell), sphere(other).center, label(other), oracle);
  return {center, squared_distance(center, point(vertices(facet)[0]))};
}

bool RestrictedDelaunay::proper(FacetId facet) const {
  const auto v = vertices(facet);
  const CellId other = neighbors(facet.cell)[facet.index];
  return *std::min_element(v.begin(), v.end()) >= Delaunay3::kCorners && other != kBeyond;
}

std::vector<Point3> RestrictedDelaunay::dual_crossings(FacetId facet, const Oracle& oracle) const {
  const Point3 *a = &sphere(facet.cell).center, *b = &sphere(neighbors(facet.cell)[facet.index]).center;
  if (std::tie(b->x, b->y, b->z) < std::tie(a->x, a->y, a->z)) std::swap(a, b);
  return oracle.intersect_all(*a, *b);
}

const SurfaceBall& RestrictedDelaunay::compute_ball(FacetId facet) {
  balls_.furnish(lane_.balls, 2, 1);
  keep_ball(facet, find_ball(facet, oracle_), lane_);
  return *ball(facet);
}

void RestrictedDelaunay::keep_ball(FacetId facet, const SurfaceBall& ball, Lane& lane) {
  const std::uint32_t number = balls_.add(ball, lane.balls);
  balls_.set(facet, number, lane.balls);
  balls_.set(mirror(facet), number, lane.balls);
}

/// If the facet has a ball, or still has it: of each, both sides may be met.
void RestrictedDelaunay::lose_ball(FacetId facet, Lane& lane) {
  const std::uint32_t number = balls_.number_of(facet);
  if (number == kNone) return;
  lane.lost.push_back(vertices(facet));
  balls_.free(number, lane.balls);
  balls_.set(facet, kNone, lane.balls);
  balls_.set(mirror(facet), kNone, lane.balls);
}

const Star& RestrictedDelaunay::evaluate(const Point3& p, CellId hint) {
  evaluate(p, hint, worker(), lane_.star);
  return lane_.star;
}

void RestrictedDelaunay::evaluate(const Point3& p, CellId hint, Worker& worker, Star& star) const {
  find_zone(p, hint, worker, star);
  if (!star.duplicate) find_tets(worker, star);
}

void RestrictedDelaunay::find_tets(Worker& worker, Star& star) const {
  delaunay_.find_tets(star, worker.search);
  for (Star::Tet& tet : star.tets) {
    const auto& v = tet.vertices;
    tet.label = label_of({v[0], v[0], v[1], v[2]}, tet.sphere, *worker.oracle);
  }
}

/// What commit() will ask of these cells is asked for now: other lanes come in between.
void RestrictedDelaunay::claim(const Lane& lane) const {
  for (CellId cell : lane.star.zone) balls_.prefetch(cell);
  for (const Star::Tet& tet : lane.star.tets) {
    balls_.prefetch(tet.outer.cell);
    labels_.prefetch(tet.outer.cell);
  }
  delaunay_.claim(lane.star, lane.claim);
}

void RestrictedDelaunay::claim(const std::array<VertexId, 3>& triangle, std::uint32_t claim) const {
  for (VertexId vertex : triangle) delaunay_.claim(vertex, claim);
}

bool RestrictedDelaunay::holds(const std::array<VertexId, 3>& triangle, std::uint32_t claim) const {
  return std::all_of(triangle.begin(), triangle.end(), [&](VertexId v) { return delaunay_.holds(v, claim); });
}

void RestrictedDelaunay::furnish(Lane& lane, bool star, std::size_t balls) {
  constexpr std::size_t kSpareCells = 256;
  if (star) delaunay_.furnish(lane.room, lane.star, kSpareCells);
  balls_.furnish(lane.balls, 2 * balls + (star ? lane.star.tets.size() : 0), balls);
  grow();
}

void RestrictedDelaunay::clear_out(Lane& lane) {
  delaunay_.clear_out(lane.room);
  balls_.clear_out(lane.balls);
}

VertexId RestrictedDelaunay::commit(VertexKind kind) {
  lane_.claim = new_claim();
  furnish(lane_, true, 0);
  const VertexId vertex = commit(lane_, kind);
  created_ = lane_.created;
  give_back_room();
  return vertex;
}

/// Insertions one by one leave more balls than they take: those are for the others.
void RestrictedDelaunay::give_back_room() {
  constexpr std::size_t kMany = 256;
  if (lane_.balls.balls.size() > kMany) balls_.clear_out(lane_.balls);
}

VertexId RestrictedDelaunay::commit(Lane& lane, VertexKind kind) {
  lane.lost.clear();
  // A ball on the zone's boundary stays if its centre is still on the shortened dual edge, that is, not in the Voronoi
  // cell of the new vertex, and the edge still bipolar.
  for (const Star::Tet& tet : lane.star.tets) {
    const SurfaceBall* kept = ball(tet.outer);
    if (kept == nullptr) continue;
    const bool covered = squared_distance(kept->center, lane.star.apex) < kept->squared_radius;
    if (covered || label(tet.outer.cell) == tet.label) {
      lose_ball(tet.outer, lane);
    } else if (!bipolar(tet.outer)) {
      lane.lost.push_back(vertices(tet.outer));  // it becomes so, and had the ball as one of Del|Sigma
    }
  }
  const VertexId vertex = commit_unlabelled(lane, kind);
  for (std::size_t i = 0; i < lane.created.size(); ++i) set_label(lane.created[i], lane.star.tets[i].label);
  return vertex;
}

/// Balls inside the zone go, those on its boundary pass to the new cells.
VertexId RestrictedDelaunay::commit_unlabelled(Lane& lane, VertexKind kind) {
  const Star& star = lane.star;
  bool any_balls = false;
  for (CellId cell : star.zone) {
    if (!balls_.any(cell)) continue;
    any_balls = true;
    for (int i = 0; i < 4 && balls_.any(cell); ++i) {
      const FacetId facet{cell, i};
      if (ball(facet) != nullptr && star.in_zone(neighbors(cell)[i])) lose_ball(facet, lane);
    }
    balls_.forget(cell, lane.balls);
  }
  const VertexId vertex = delaunay_.commit(star, lane.claim, lane.room, lane.created);
  kinds_[vertex] = kind;
  for (std::size_t i = 0; i < lane.created.size() && any_balls; ++i) {
    balls_.set({lane.created[i], 0}, balls_.number_of(star.tets[i].outer), lane.balls);
  }
  return vertex;
}

void RestrictedDelaunay::remove(VertexId vertex) {
  lane_.lost.clear();
  for (CellId cell : incident_cells(vertex)) {
    for (int i = 0; i < 4; ++i) lose_ball({cell, i}, lane_);
  }
  delaunay_.remove(vertex, destroyed_, created_);
  kinds_[vertex] = VertexKind::kRemoved;
  grow();
  for (CellId cell : created_) describe(cell, oracle_);
  give_back_room();
}

}  // namespace delvox
