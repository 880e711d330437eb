#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/freed_memory.h"
#include "core/parallel.h"
#include "meshing/refinement.h"

namespace delvox {
namespace {

double shortest_squared_edge(const RestrictedDelaunay& delaunay, CellId cell) {
  const auto& v = delaunay.vertices(cell);
  double shortest = squared_distance(delaunay.point(v[0]), delaunay.point(v[1]));
  for (int i = 0; i < 4; ++i) {
    for (int j = std::max(i + 1, 2); j < 4; ++j) {
      shortest = std::min(shortest, squared_distance(delaunay.point(v[i]), delaunay.point(v[j])));
    }
  }
  return shortest;
}

}  // namespace

void Refinement::watch_tets(const TetCriteria& criteria) {
  tet_criteria_ = &criteria;
  give_back_freed_memory();  // what seeds and lattice took, while the mesh was small
  constexpr std::size_t kChunk = 4096;
  constexpr CellId kAhead = 8;
  const auto in_question = [&](CellId cell) {
    const std::uint32_t stamp = delaunay_.stamp(cell);
    return stamp != 0 && stamp != lattice_stamp_ && delaunay_.label(cell) != 0;
  };
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<RefinementQueues::WaitingTet>& found) {
    for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
      if (cell + kAhead < end && in_question(cell + kAhead)) delaunay_.prefetch_vertices(cell + kAhead);
      if (in_question(cell) && bad(cell)) found.push_back({cell, delaunay_.stamp(cell)});
    }
  };
  queues_.tets = gather_chunks<RefinementQueues::WaitingTet>(delaunay_.cell_capacity(), kChunk, collect);
}

bool Refinement::bad(CellId cell) const {
  const Circumsphere& sphere = delaunay_.sphere(cell);
  const double size = tet_criteria_->cell_size(sphere.center);
  if (sphere.squared_radius > size * size * (1 - 1e-12)) return true;
  // At sharp edges as in Refinement::Refinement(): the surface point that goes in instead of a circumcentre is at least
  // half as far from all vertices.
  constexpr double kAtFeatures = 2 * std::numbers::sqrt2 * 1.02;
  const double largest =
      touches_feature(cell) ? std::max(tet_criteria_->radius_edge, kAtFeatures) : tet_criteria_->radius_edge;
  const double bound = largest * largest * (1 - 1e-9);
  return sphere.squared_radius > bound * shortest_squared_edge(delaunay_, cell);
}

/// The last tet waiting: leaves the queue if it is gone or nothing can be inserted for it.
void Refinement::look_at_tet(RefinementLane& lane, RefinementQueues& queues, Worker& worker, bool alone) {
  const auto waiting = queues.tets.back();
  if (!delaunay_.alive(waiting.cell, waiting.stamp)) return queues.tets.pop_back();
  Point3 p = delaunay_.sphere(waiting.cell).center;
  Star& star = lane.lane.star;
  VertexKind kind = VertexKind::kInterior;  // 7(b)
  // 7(a): z lies in a surface ball; 7(c): z would create a restricted triangle. A point beside z goes in instead, or
  // the ball's centre.
  PlacedBall found = encroached_ball_beside(waiting.cell, *worker.oracle);
  if (found.ball.squared_radius == 0) found = find_obstacle(p, waiting.cell, worker, star);
  if (found.ball.squared_radius > 0) {
    const auto aside = point_aside(waiting.cell, found.ball, worker, star);
    kind = aside ? VertexKind::kInterior : VertexKind::kSurface;
    p = aside.value_or(found.ball.center);
  }
  if (leaves_to_features(waiting, p, lane, queues, alone)) return;
  if (kind == VertexKind::kSurface) delaunay_.evaluate(p, found.near, worker, star);
  if (star.duplicate) {
    ++lane.stuck;
    lane.stuck_place = p;
    return queues.tets.pop_back();
  }
  lane.insertion = kind;
  lane.purpose = RefinementLane::Purpose::kTet;
}

/// The largest surface ball that contains a point in the circumball of a cell, or if none does, of those that the point
/// would create; else its radius is 0. Leaves the point's star; where there is an obstacle, not all of it.
Refinement::PlacedBall Refinement::find_obstacle(const Point3& p, CellId cell, Worker& worker, Star& star) const {
  PlacedBall largest;
  delaunay_.find_zone(p, cell, worker, star);
  find_encroached_ball(p, {star.zone.begin(), star.zone.size()}, *worker.oracle, largest);
  if (star.duplicate || largest.ball.squared_radius > 0) return largest;
  delaunay_.find_tets(worker, star);
  find_new_ball(star, *worker.oracle, largest);
  return largest;
}

/// Not in the book, where the ball on which the circumcentre z of a bad tet encroaches is always split: a point a
/// little further from its centre may do as well, and the surface keeps to the vertices that it needs itself. At up to
/// 1 - 1/sqrt(2) circumradii from z no vertex is nearer to it than 1/sqrt(2) of these: for a radius-edge ratio of 2 or
/// more that is no less than the shortest edge, and proposition 14.13 holds, by which refinement ends. None if the
/// point is on another side, encroaches on a sharp edge or has an obstacle, too; else `star` is its star.
std::optional<Point3> Refinement::point_aside(CellId cell, const SurfaceBall& ball, Worker& worker, Star& star) const {
  constexpr double kLeast = 0.1, kMost = 1 - 1 / std::numbers::sqrt2, kClear = 1 + 1e-4;
  const Point3& z = delaunay_.sphere(cell).center;
  const double circumradius = std::sqrt(delaunay_.sphere(cell).squared_radius);
  const double away = norm(z - ball.center);
  const double to_go = std::max(kClear * std::sqrt(ball.squared_radius) - away, kLeast * circumradius);
  if (away == 0 || to_go > kMost * circumradius) return std::nullopt;
  const Point3 p = z + (to_go / away) * (z - ball.center);
  if (worker.oracle->label(p) != delaunay_.label(cell)) return std::nullopt;
  if (features_ && features_->encroached_by(p)) return std::nullopt;
  const PlacedBall obstacle = find_obstacle(p, cell, worker, star);
  return star.duplicate || obstacle.ball.squared_radius > 0 ? std::nullopt : std::optional(p);
}

/// The point that is to be inserted for the last tet waiting may encroach on a segment. True if it does: that is split,
/// and the tet waits on, or the tet is left as it is.
bool Refinement::leaves_to_features(const RefinementQueues::WaitingTet& waiting, const Point3& p, RefinementLane& lane,
                                    RefinementQueues& queues, bool alone) {
  const Circumsphere& sphere = delaunay_.sphere(waiting.cell);
  const double size = features_ ? tet_criteria_->cell_size(sphere.center) : 0;
  std::uint32_t segment = 0;
  const AtFeature at = at_feature(p, sphere.squared_radius <= size * size && touches_feature(waiting.cell), segment);
  if (at == AtFeature::kClear) return false;
  if (at == AtFeature::kSplit && alone && budget_left() && split_feature(segment)) return true;
  if (at == AtFeature::kSplit && !alone) lane.aside.tets.push_back(waiting);
  queues.tets.pop_back();
  return true;
}

/// A surface ball that contains a cell's circumcentre, of its facets or of its neighbours': most that contain it are
/// met here, with no search for the zone.
Refinement::PlacedBall Refinement::encroached_ball_beside(CellId cell, const Oracle& oracle) const {
  const auto& beside = delaunay_.neighbors(cell);
  const std::array<CellId, 5> around{cell, beside[0], beside[1], beside[2], beside[3]};
  PlacedBall largest;
  find_encroached_ball(delaunay_.sphere(cell).center, around, oracle, largest);
  return largest;
}

/// A surface ball that contains z belongs to a facet of a cell whose circumsphere contains z, one of these cells.
void Refinement::find_encroached_ball(const Point3& z, std::span<const CellId> cells, const Oracle& oracle,
                                      PlacedBall& largest) const {
  for (CellId cell : cells) {
    if (!delaunay_.has_balls(cell)) continue;
    const auto consider = [&](const Point3& center, double squared_radius) {
      if (squared_radius <= largest.ball.squared_radius || squared_distance(center, z) >= squared_radius) return;
      largest = {{center, squared_radius}, cell};
    };
    for (int i = 0; i < 4; ++i) {
      const SurfaceBall* ball = delaunay_.ball({cell, i});
      if (ball == nullptr) continue;
      consider(ball->center, ball->squared_radius);
      if (variant_.restricted == Restricted::kBipolar) continue;  // else the triangle may have others too
      const Point3& corner = delaunay_.point(delaunay_.vertices(FacetId{cell, i})[0]);
      for (const Point3& center : delaunay_.dual_crossings({cell, i}, oracle)) {
        consider(center, squared_distance(center, corner));
      }
    }
  }
}

/// Of the restricted triangles that the star would have and the mesh has not. Facets on the boundary of its zone keep a
/// part of their dual edges, which may be bipolar where the whole was not.
void Refinement::find_new_ball(const Star& star, const Oracle& oracle, PlacedBall& largest) const {
  const auto consider = [&](const Point3& center, const Point3& corner) {
    const double squared_radius = squared_distance(center, corner);
    if (squared_radius > largest.ball.squared_radius) largest = {{center, squared_radius}, star.zone.front()};
  };
  bool uniform = variant_.restricted == Restricted::kBipolar;
  for (const Star::Tet& tet : star.tets) {
    uniform &= tet.label == star.tets.front().label;
    const CellId outer = tet.outer.cell;
    if (delaunay_.label(outer) == tet.label || delaunay_.bipolar(tet.outer)) continue;
    consider(RestrictedDelaunay::dual_crossing(delaunay_.sphere(outer).center, delaunay_.label(outer),
                                               tet.sphere.center, tet.label, oracle),
             delaunay_.point(tet.vertices[0]));
  }
  if (uniform) return;
  for (std::uint32_t t = 0; t < star.tets.size(); ++t) {
    const Star::Tet& a = star.tets[t];
    for (int i = 0; i < 3; ++i) {
      const Star::Tet& b = star.tets[a.beside[i]];
      if (a.beside[i] <= t) continue;
      if (a.label != b.label) {
        consider(RestrictedDelaunay::dual_crossing(a.sphere.center, a.label, b.sphere.center, b.label, oracle),
                 star.apex);
      }
      const bool proper = std::min(a.vertices[(i + 1) % 3], a.vertices[(i + 2) % 3]) >= Delaunay3::kCorners;
      if (variant_.restricted == Restricted::kBipolar || !proper) continue;
      for (const Point3& center : oracle.intersect_all(a.sphere.center, b.sphere.center)) consider(center, star.apex);
    }
  }
}

}  // namespace delvox
