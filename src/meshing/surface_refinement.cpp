#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "delvox/core/errors.h"
#include "meshing/refinement.h"
#include "meshing/surface_verdict.h"
#include "meshing/umbrella.h"

namespace delvox {

Refinement::Refinement(const Oracle& oracle, const SurfaceCriteria& surface, const RunControl& control,
                       const Variant& variant, RunReport& report)
    : oracle_(oracle),
      surface_(surface),
      variant_(variant),
      report_(report),
      budget_(control, report),
      delaunay_(oracle),
      random_(variant.seed),
      effort_(surface.thin_ball_radius) {
  // Balls that are mere rounding errors of the oracle's points would be split without end.
  constexpr double kRoundingError = 1e-7;
  surface_.min_ball_radius = std::max(surface_.min_ball_radius, kRoundingError * oracle.bounds().diagonal());
  surface_.min_smooth_radius = std::max(surface_.min_smooth_radius, surface_.min_ball_radius);
  // Triangles at sharp edges are split as far as that makes no edge shorter than sqrt(2) times those at hand, so that
  // others, whose centres may encroach on segments of up to sqrt(2) times their radius, never make these shorter.
  const double kHalfRightAngle = std::asin(1 / (2 * std::numbers::sqrt2 * 1.02)) * 180 / std::numbers::pi;
  touching_ = surface_;
  touching_.min_angle_degrees = std::min(surface_.min_angle_degrees, kHalfRightAngle);
}

void Refinement::enqueue(std::span<const CellId> created, std::uint32_t oldest, RefinementQueues& queues) const {
  // A ball that outlives its cell may be one that is to be split, and waited with that, of tets or once Quality began.
  const bool may_wait = tet_criteria_ != nullptr || !persistent_.empty();
  for (CellId cell : created) {
    const std::uint32_t stamp = delaunay_.stamp(cell);
    if (tet_criteria_ != nullptr && delaunay_.label(cell) != 0 && bad(cell)) queues.tets.push_back({cell, stamp});
    // Few facets are bipolar, and which cannot be foreseen: all four are asked before any is looked into.
    unsigned facets = 0;
    for (int i = 0; i < 4; ++i) facets |= static_cast<unsigned>(may_be_restricted({cell, i})) << i;
    for (; facets != 0; facets &= facets - 1) {
      const FacetId facet{cell, std::countr_zero(facets)};
      const SurfaceBall* ball = delaunay_.ball(facet);
      if (ball != nullptr && (!may_wait || judge(facet, *ball) != Verdict::kSplit)) continue;
      const CellId neighbor = delaunay_.neighbors(cell)[facet.index];
      const bool met_from_there = neighbor < cell && delaunay_.stamp(neighbor) >= oldest;
      if (!met_from_there) queues.facets.push_back({facet, stamp});
    }
  }
}

std::uint32_t Refinement::oldest_stamp(const std::vector<CellId>& created) const {
  std::uint32_t oldest = ~std::uint32_t{0};
  for (CellId cell : created) oldest = std::min(oldest, delaunay_.stamp(cell));
  return oldest;
}

void Refinement::enqueue_created() {
  constexpr std::size_t kChunk = 4096;
  const std::vector<CellId>& created = delaunay_.created();
  const std::uint32_t oldest = oldest_stamp(created);
  if (created.size() <= kChunk) return enqueue(created, oldest, queues_);
  const auto parts = map_chunks(created.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    RefinementQueues part;
    enqueue({created.data() + begin, created.data() + end}, oldest, part);
    return part;
  });
  for (const RefinementQueues& part : parts) queues_.append(part);
}

bool Refinement::has_interior_vertex(FacetId facet) const {
  const auto vertices = delaunay_.vertices(facet);
  return std::any_of(vertices.begin(), vertices.end(),
                     [this](VertexId v) { return delaunay_.kind(v) == VertexKind::kInterior; });
}

/// Step 2: a vertex off the surface has no place in a restricted triangle.
void Refinement::remove_interior_vertex_of(FacetId facet) {
  const auto vertices = delaunay_.vertices(facet);
  const VertexId vertex = *std::find_if(vertices.begin(), vertices.end(),
                                        [this](VertexId v) { return delaunay_.kind(v) == VertexKind::kInterior; });
  remove_vertex(vertex);
}

void Refinement::remove_vertex(VertexId vertex) {
  const bool on_surface = delaunay_.kind(vertex) == VertexKind::kSurface;
  delaunay_.remove(vertex);
  mark_lost_dirty();
  note_new_facets();
  for (CellId cell : delaunay_.created()) {
    const auto& corners = delaunay_.vertices(cell);
    if (edges_looked_at_) since_edges_.insert(since_edges_.end(), corners.begin(), corners.end());
    for (VertexId corner : corners) {
      if (on_surface && delaunay_.kind(corner) == VertexKind::kSurface) mark_dirty(corner);
    }
  }
  ++report_.removals;
  enqueue_created();
}

/// The surface ball by which to judge a facet: the one that exceeds the size by most, if any does, else the largest.
/// None if the facet is not restricted.
std::optional<SurfaceBall> Refinement::find_ball(FacetId facet, const Oracle& oracle) const {
  const bool bipolar = delaunay_.bipolar(facet);
  if (bipolar && variant_.restricted == Restricted::kBipolar) return delaunay_.find_ball(facet, oracle);
  if (!may_be_restricted(facet)) return std::nullopt;
  const std::vector<Point3> crossings = delaunay_.dual_crossings(facet, oracle);
  if (crossings.empty()) return bipolar ? std::optional(delaunay_.find_ball(facet, oracle)) : std::nullopt;
  const Point3& corner = delaunay_.point(delaunay_.vertices(facet)[0]);
  SurfaceBall largest, excess;
  double most = 1;
  for (const Point3& center : crossings) {
    const SurfaceBall ball{center, squared_distance(center, corner)};
    const double size = surface_.size(center), ratio = ball.squared_radius / (size * size);
    if (ball.squared_radius > largest.squared_radius) largest = ball;
    if (ratio > most) most = ratio, excess = ball;
  }
  return most > 1 ? excess : largest;
}

/// Size, Quality and deviation, and of Del|Sigma step 4 of DelTetSurf: is the facet's ball to be split?
Refinement::Verdict Refinement::judge(FacetId facet, const SurfaceBall& ball) const {
  const bool two_faced = !delaunay_.bipolar(facet);
  if (two_faced || !shapes_matter()) {
    const double size = surface_.size(ball.center), left = surface_.min_smooth_radius;
    if (ball.squared_radius > size * size) return Verdict::kSplit;
    if (!two_faced) return Verdict::kGood;
    return ball.squared_radius <= left * left ? Verdict::kTwoFaced : Verdict::kSplit;
  }
  const auto v = delaunay_.vertices(facet);
  const SurfaceCriteria& criteria = touches_feature(facet) ? touching_ : surface_;
  switch (delvox::judge(criteria, delaunay_.point(v[0]), delaunay_.point(v[1]), delaunay_.point(v[2]), ball)) {
    case SurfaceVerdict::kGood: return Verdict::kGood;
    case SurfaceVerdict::kSplit: break;
    case SurfaceVerdict::kTooDeviant: return Verdict::kTooDeviant;
  }
  const bool leave = leaves_dense_ && dense_at(delaunay_.point(v[0]), delaunay_.point(v[1]), delaunay_.point(v[2]), ball);
  return leave ? Verdict::kGood : Verdict::kSplit;
}

std::optional<VertexId> Refinement::insert_surface_point(const Point3& p, CellId hint) {
  delaunay_.evaluate(p, hint);
  return insert_apex_on_surface();
}

std::optional<VertexId> Refinement::insert_on_surface(const Point3& p, CellId hint) {
  delaunay_.evaluate(p, hint);
  return insert_apex();
}

/// Where it encroaches on a segment, that is split instead.
std::optional<VertexId> Refinement::insert_apex_on_surface() {
  const auto encroached = features_ ? features_->encroached_by(delaunay_.star().apex) : std::nullopt;
  return encroached ? split_feature(*encroached) : insert_apex();
}

/// Of the star that was evaluated last.
std::optional<VertexId> Refinement::insert_apex() {
  const Star& star = delaunay_.star();
  if (star.duplicate) {
    ++stuck_;
    stuck_place_ = star.apex;
    return std::nullopt;
  }
  const Box3 changing = watch_.empty() ? Box3{} : box_of_change(star);
  const VertexId inserted = delaunay_.commit(VertexKind::kSurface);
  mark_lost_dirty();
  if (!watch_.empty()) note_change(changing, inserted);
  enqueue_created();
  return inserted;
}

void Refinement::mark_dirty(const std::array<VertexId, 3>& triangle) {
  for (VertexId vertex : triangle) mark_dirty(vertex);
}

void Refinement::mark_lost_dirty() {
  for (const auto& triangle : delaunay_.lost()) mark_dirty(triangle);
}

void Refinement::mark_dirty(VertexId vertex) {
  if (vertex >= is_dirty_.size()) is_dirty_.resize(delaunay_.vertex_capacity(), 0);
  if (is_dirty_[vertex]) return;
  is_dirty_[vertex] = 1;
  dirty_.push_back(vertex);
}

void Refinement::report_unmet() {
  const auto tell = [this](const char* criterion, std::size_t count, const std::optional<Point3>& where,
                           const char* reason, bool breaks_promise) {
    if (count > 0) report_.unmet.push_back({criterion, count, where, reason, breaks_promise});
  };
  std::size_t broken = 0;
  Point3 where;
  if (effort_.hopeless()) {
    for (const auto* waiting : {&dirty_, &deferred_}) {
      unrepaired_.insert(unrepaired_.end(), waiting->begin(), waiting->end());
    }
  }
  std::sort(unrepaired_.begin(), unrepaired_.end());
  unrepaired_.erase(std::unique(unrepaired_.begin(), unrepaired_.end()), unrepaired_.end());
  for (VertexId vertex : unrepaired_) {
    if (delaunay_.kind(vertex) != VertexKind::kSurface || find_umbrella(delaunay_, vertex).disk) continue;
    ++broken;
    where = delaunay_.point(vertex);
  }
  tell("topology", broken, where,
       effort_.hopeless()
           ? "the triangles at a vertex form no disk, and the smaller the balls, the more of them it takes"
           : "the triangles at a vertex form no disk at the smallest ball radius",
       true);
  std::erase_if(uncovered_, [this](std::uint32_t segment) { return covered(segment); });
  tell("sharp edges", uncovered_.size(), uncovered_.empty() ? where : features_->middle(uncovered_[0]),
       "part of a sharp edge is no edge between two triangles at the smallest ball radius", true);
  tell("deviation", too_deviant_, deviant_place_, "not met at the smallest ball radius", false);
  report_roughness();
  std::erase_if(two_faced_, [this](const auto& left) {
    return !delaunay_.alive(left.facet.cell, left.stamp) || delaunay_.bipolar(left.facet);
  });
  tell("two-faced triangles", two_faced_.size(),
       two_faced_.empty() ? where : delaunay_.point(delaunay_.vertices(two_faced_[0].facet)[0]),
       "a Voronoi edge leaves its side for less than the smallest ball radius", false);
  for (const PersistentTriangle& triangle : persistent_) {
    tell("persistent triangle", stays(triangle), triangle.points[0], "refinement was stuck without its vertices",
         false);
  }
  if (expected_topology_ && broken == 0 && queues_.facets_waiting() == 0 && topology() != *expected_topology_) {
    tell("topology", 1, std::nullopt,
         "components or Euler number differ from the voxels': some neck or gap is too thin to be found", false);
  }
  tell("landmark", lost_landmarks_, lost_place_, "a neck, gap or speck of the voxels is below the smallest ball radius",
       false);
  tell("refinement", stuck_, stuck_place_, "a new point coincides with a vertex", true);
}

}  // namespace delvox
