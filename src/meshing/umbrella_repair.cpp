#include <algorithm>
#include <cmath>
#include <utility>

#include "meshing/refinement.h"
#include "meshing/umbrella.h"

namespace delvox {

bool Refinement::repair_topology() {
  std::vector<VertexId> round;
  round.swap(dirty_);
  for (VertexId vertex : round) is_dirty_[vertex] = 0;
  std::erase_if(round, [this](VertexId vertex) { return delaunay_.kind(vertex) != VertexKind::kSurface; });
  if (wants_smooth()) since_smooth_.insert(since_smooth_.end(), round.begin(), round.end());
  if (!surface_.topo_disk || !budget_left()) return false;
  return repair_umbrellas(without_disk(delaunay_, round), !watch_.empty());
}

/// Step 5 for those that waited for landmarks and links.
bool Refinement::repair_deferred_umbrellas() {
  return repair_umbrellas(std::exchange(deferred_, {}), false);
}

/// TopoDisk(p) for each vertex p: in lanes, then what must be done alone. True if anything was inserted.
bool Refinement::repair_umbrellas(std::vector<VertexId> waiting, bool may_defer) {
  const std::size_t before = report_.topology_insertions;
  std::vector<VertexId> aside;
  while (!waiting.empty() && budget_left()) run_umbrella_lanes(waiting, aside, may_defer);
  for (VertexId vertex : aside) {
    if (!budget_left()) break;
    split_feature_for(vertex, may_defer);
  }
  return report_.topology_insertions > before;
}

/// Gives each lane its share, and lets them work.
void Refinement::run_umbrella_lanes(std::vector<VertexId>& waiting, std::vector<VertexId>& aside, bool may_defer) {
  for (std::size_t i = 0; i < kLanes; ++i) take_share(waiting, 0, i, kLanes, lanes_[i].umbrellas);
  waiting.clear();
  run_rounds([&](RefinementLane& lane) { look_at_umbrellas(lane, may_defer); },
             [](const RefinementLane& lane) { return lane.next_umbrella < lane.umbrellas.size(); });
  for (RefinementLane& lane : lanes_) {
    take_share(lane.umbrellas, lane.next_umbrella, 0, 1, waiting);
    lane.umbrellas.clear();
    lane.next_umbrella = 0;
    take_over(lane.umbrellas_aside, aside);
    queues_.append(std::exchange(lane.queues, {}));
    collect(lane);
  }
}

/// The next umbrellas of the lane, up to one for which something is to be inserted.
void Refinement::look_at_umbrellas(RefinementLane& lane, bool may_defer) {
  lane.judged.clear();
  lane.insertion.reset();
  Worker& worker = delaunay_.worker();
  for (; lane.next_umbrella < lane.umbrellas.size(); ++lane.next_umbrella) {
    const VertexId vertex = lane.umbrellas[lane.next_umbrella];
    const PlacedBall largest = ball_to_split(vertex, lane, may_defer);
    if (largest.near == kNone) continue;
    if (features_ && features_->encroached_by(largest.ball.center)) {
      lane.umbrellas_aside.push_back(vertex);
      continue;
    }
    delaunay_.evaluate(largest.ball.center, largest.near, worker, lane.lane.star);
    if (lane.lane.star.duplicate) {
      ++lane.stuck;
      lane.stuck_place = largest.ball.center;
      lane.umbrellas_unrepaired.push_back(vertex);
      continue;
    }
    lane.insertion = VertexKind::kSurface;
    lane.purpose = RefinementLane::Purpose::kUmbrella;
    lane.split_radius = std::sqrt(largest.ball.squared_radius);
    return claim(lane);
  }
}

/// The largest surface ball at a vertex whose triangles form no disk; none if nothing is to be inserted now. Where it is
/// small, a neck or gap may be missing, and the smaller the balls, the more of them it would take: if it `may_defer`, it
/// waits until landmarks and links have what they ask for.
Refinement::PlacedBall Refinement::ball_to_split(VertexId vertex, RefinementLane& lane, bool may_defer) const {
  if (delaunay_.kind(vertex) != VertexKind::kSurface) return {};
  const Umbrella umbrella = find_umbrella(delaunay_, vertex);
  if (umbrella.disk) return {};
  PlacedBall largest;
  for (const FacetId& candidate : umbrella.facets) {
    const SurfaceBall* ball = delaunay_.ball(candidate);
    if (ball == nullptr) {
      // An insertion of this call made the facet: it waits to be judged, and the umbrella for the next call. (While
      // tets are watched, facets are judged as they are made.)
      lane.dirty.add(delaunay_.vertices(candidate));
      return {};
    }
    if (ball->squared_radius > largest.ball.squared_radius) largest = {*ball, candidate.cell};
  }
  constexpr double kSmall = 0.25;  // of the size
  const double small = kSmall * surface_.size(largest.ball.center);
  if (may_defer && largest.ball.squared_radius < small * small) {
    lane.umbrellas_deferred.push_back(vertex);
    return {};
  }
  if (largest.ball.squared_radius <= surface_.min_ball_radius * surface_.min_ball_radius) {
    lane.umbrellas_unrepaired.push_back(vertex);
    return {};
  }
  return largest;
}

/// Where the ball's centre encroaches on a segment, that is split instead.
void Refinement::split_feature_for(VertexId vertex, bool may_defer) {
  RefinementLane& lane = lanes_.front();
  const PlacedBall largest = ball_to_split(vertex, lane, may_defer);
  collect(lane);
  if (largest.near == kNone) return;
  if (!insert_surface_point(largest.ball.center, largest.near)) {
    unrepaired_.push_back(vertex);
    return;
  }
  mark_dirty(vertex);
  count_umbrella(std::sqrt(largest.ball.squared_radius));
}

void Refinement::count_umbrella(double split_radius) {
  // What Voronoi edges have asked for makes small balls, hence work here, where nothing is as thin as all that.
  if (!edges_looked_at_) effort_.add(split_radius, vertex_count());
  ++report_.topology_insertions;
}

void Refinement::collect_umbrellas(RefinementLane& lane) {
  for (double radius : lane.radii_for_umbrellas) count_umbrella(radius);
  lane.radii_for_umbrellas.clear();
  take_over(lane.umbrellas_deferred, deferred_);
  take_over(lane.umbrellas_unrepaired, unrepaired_);
}

}  // namespace delvox
