#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/freed_memory.h"
#include "core/parallel.h"
#include "core/sort_by_key.h"
#include "delaunay/spatial_order.h"
#include "meshing/refinement.h"

namespace delvox {
namespace {

constexpr std::size_t kFewestPerLane = 32;
/// Copies of this many entries are a burden once they are freed.
constexpr std::size_t kManyWaiting = 1 << 15;
/// Facets that a lane may judge before the others are waited for.
constexpr std::size_t kMostJudged = 16;

/// Sorts the entries from number `first` on by their keys.
template <class Waiting, class KeyOf>
void sort_by(const KeyOf& key_of, std::vector<Waiting>& entries, std::size_t first) {
  constexpr std::size_t kChunk = 4096;
  std::vector<KeyedIndex> keys(entries.size() - first);
  for_each_chunk(keys.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) keys[i] = {key_of(entries[first + i]), static_cast<std::uint32_t>(i)};
  });
  if (std::is_sorted(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.key < b.key; })) return;
  sort_by_key(keys);
  std::vector<Waiting> sorted(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(first));
  sorted.reserve(entries.size());
  for (const KeyedIndex& key : keys) sorted.push_back(entries[first + key.index]);
  entries = std::move(sorted);
}

/// All that waits in either, in the order that `first` comes out first.
RefinementQueues joined(const RefinementQueues& first, const RefinementQueues& then) {
  RefinementQueues both;
  both.facets.assign(first.facets.begin() + static_cast<std::ptrdiff_t>(first.next_facet), first.facets.end());
  both.tets = then.tets;
  take_share(then.facets, then.next_facet, 0, 1, both.facets);
  take_share(first.tets, 0, 0, 1, both.tets);
  return both;
}

}  // namespace

bool Refinement::enough_for_lanes(std::size_t waiting) { return waiting >= kLanes * kFewestPerLane; }

/// In lanes as long as there is enough for them, then what must or may as well be done alone.
void Refinement::refine() {
  while (queues_.waiting() > 0 && !budget_.exhausted()) {
    if (queues_.facets_waiting() > 0 && !queues_.tets.empty()) {
      // Facets first: a tet must not be split in a surface ball that is not known yet.
      const auto tets = std::exchange(queues_.tets, {});
      refine();
      queues_.tets.insert(queues_.tets.begin(), tets.begin(), tets.end());
      continue;
    }
    RefinementQueues aside;
    while (enough_for_lanes(queues_.waiting()) && !budget_.exhausted()) run_lanes(aside);
    const std::size_t at_least = aside.waiting();
    queues_ = joined(aside, queues_);
    run_alone(at_least);
  }
}

/// So that each lane gets a place of its own: facets along a curve through space, as those of the same cells and
/// vertices are to be looked at one after the other; tets, which are fewer, by their cells, made along such a curve in
/// their time. Entries that are dead by now may come anywhere.
void Refinement::sort_by_place() {
  place_vertices();
  const auto place = [&](const RefinementQueues::WaitingFacet& waiting) {
    return std::uint64_t{places_[delaunay_.vertices(waiting.facet.cell)[0]]};
  };
  const auto cell = [](const RefinementQueues::WaitingTet& waiting) { return std::uint64_t{waiting.cell}; };
  sort_by(place, queues_.facets, queues_.next_facet);
  sort_by(cell, queues_.tets, 0);
}

/// Finds out where along the curve the vertices are that have come since. Where a number is given to another vertex
/// later, or had none yet, its place is not true: entries there come at a less fitting time.
void Refinement::place_vertices() {
  constexpr std::size_t kChunk = 4096;
  constexpr int kUnusedBits = 4;  // of 36: the rest fits into half the memory
  const Box3 box = oracle_.bounds();
  const std::size_t known = places_.size();
  places_.resize(delaunay_.vertex_capacity());
  for_each_chunk(places_.size() - known, kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = known + begin; v < known + end; ++v) {
      const std::uint64_t place = place_along_curve(delaunay_.point(static_cast<VertexId>(v)), box);
      places_[v] = static_cast<std::uint32_t>(place >> kUnusedBits);
    }
  });
}

/// Gives each lane its share of what waits, and lets them work.
void Refinement::run_lanes(RefinementQueues& aside) {
  sort_by_place();
  for (std::size_t i = 0; i < kLanes; ++i) {
    take_share(queues_.facets, queues_.next_facet, i, kLanes, lanes_[i].queues.facets);
    take_share(queues_.tets, 0, i, kLanes, lanes_[i].queues.tets);
  }
  const bool many = queues_.waiting() > kManyWaiting;
  queues_ = {};
  if (many) give_back_freed_memory();  // what it took to sort them
  run_rounds([&](RefinementLane& lane) { look(lane, lane.queues, false); },
             [](const RefinementLane& lane) { return lane.queues.waiting() > 0; });
  for (RefinementLane& lane : lanes_) {
    queues_.append(std::exchange(lane.queues, {}));
    aside.append(std::exchange(lane.aside, {}));
    collect(lane);
  }
}

/// At least one, then on until half of the lanes have no work left.
void Refinement::run_rounds(const std::function<void(RefinementLane&)>& look,
                            const std::function<bool(const RefinementLane&)>& has_work) {
  do {
    run_round(look);
  } while (2 * std::count_if(lanes_.begin(), lanes_.end(), has_work) > std::ptrdiff_t{kLanes} && !budget_.exhausted());
}

/// Each lane finds out what it is to do next, then those that hold their claims do it.
void Refinement::run_round(const std::function<void(RefinementLane&)>& look) {
  std::uint32_t claim = delaunay_.new_claims();
  for (RefinementLane& lane : lanes_) lane.lane.claim = claim++;
  delaunay_.team().for_each(kLanes, [&](std::size_t i) { look(lanes_[i]); });
  keep_to_budget();
  for (RefinementLane& lane : lanes_) furnish(lane);
  delaunay_.team().for_each(kLanes, [&](std::size_t i) { conclude(lanes_[i], lanes_[i].queues); });
}

/// Takes back insertions that the budget has no room for.
void Refinement::keep_to_budget() {
  const auto inserts = [](const RefinementLane& lane) { return lane.insertion.has_value(); };
  if (std::none_of(lanes_.begin(), lanes_.end(), inserts)) return;
  std::size_t room = budget_left() ? budget_.room(vertex_count()) : 0;
  if (room >= kLanes) return;
  for (RefinementLane& lane : lanes_) {
    if (room == 0) lane.insertion.reset();
    if (lane.insertion && delaunay_.holds(lane.lane)) --room;
  }
}

/// One thing after the other, at least so many, and on until there is enough for several lanes.
void Refinement::run_alone(std::size_t at_least) {
  RefinementLane& lane = lanes_.front();
  for (std::size_t done = 0; queues_.waiting() > 0; ++done) {
    if (done >= at_least && enough_for_lanes(queues_.waiting())) break;
    lane.lane.claim = delaunay_.new_claim();
    look(lane, queues_, true);
    if (lane.insertion && !budget_left()) break;
    furnish(lane);
    conclude(lane, queues_);
  }
  collect(lane);
}

void Refinement::furnish(RefinementLane& lane) {
  if (lane.insertion || !lane.judged.empty()) {
    // No star has more facets than twice its tets.
    const std::size_t new_facets = lane.insertion && tet_criteria_ != nullptr ? 2 * lane.lane.star.tets.size() + 2 : 0;
    delaunay_.furnish(lane.lane, lane.insertion.has_value(), lane.judged.size() + new_facets);
  }
}

void Refinement::collect(RefinementLane& lane) {
  for (VertexId vertex : lane.dirty.all()) mark_dirty(vertex);
  for (const RefinementLane::Change& change : lane.changes) note_change(change.box, change.near);
  collect_umbrellas(lane);
  report_.surface_insertions += std::exchange(lane.surface_insertions, 0);
  report_.interior_insertions += std::exchange(lane.interior_insertions, 0);
  if (lane.too_deviant > 0) deviant_place_ = lane.deviant_place;
  too_deviant_ += std::exchange(lane.too_deviant, 0);
  if (lane.stuck > 0) stuck_place_ = lane.stuck_place;
  stuck_ += std::exchange(lane.stuck, 0);
  take_over(lane.two_faced, two_faced_);
  lane.dirty.clear();
  lane.changes = {};
  delaunay_.clear_out(lane.lane);
}

void Refinement::retire() {
  const auto clear = [](auto& member) { member = std::remove_reference_t<decltype(member)>(); };
  clear(queues_);
  clear(lanes_);
  clear(dirty_);
  clear(is_dirty_);
  clear(places_);
  clear(watch_);
  clear(landmark_places_);
  clear(since_edges_);
  delaunay_.retire_balls();
  give_back_freed_memory();
}

/// Finds out what is to be done next, and claims what that touches: steps 2 and 3 first, step 7 only if no facet waits.
/// Changes nothing that other lanes could see, unless it is `alone`.
void Refinement::look(RefinementLane& lane, RefinementQueues& queues, bool alone) {
  lane.judged.clear();
  lane.insertion.reset();
  Worker& worker = delaunay_.worker();
  bool going = true;
  while (going && queues.facets_waiting() > 0 && !lane.insertion && lane.judged.size() < kMostJudged) {
    going = look_at_facet(lane, queues, worker, alone);
  }
  while (lane.judged.empty() && queues.facets_waiting() == 0 && !queues.tets.empty() && !lane.insertion) {
    constexpr std::size_t kAhead = 4;
    if (kAhead < queues.tets.size()) delaunay_.prefetch(queues.tets[queues.tets.size() - kAhead - 1].cell);
    look_at_tet(lane, queues, worker, alone);
  }
  claim(lane);
}

void Refinement::add_judged(RefinementLane& lane, const RefinementQueues::WaitingFacet& waiting,
                            const SurfaceBall& ball, bool too_deviant) const {
  lane.judged.push_back({waiting, ball, too_deviant, delaunay_.vertices(waiting.facet)});
}

void Refinement::claim(RefinementLane& lane) {
  for (const auto& judged : lane.judged) delaunay_.claim(judged.vertices, lane.lane.claim);
  if (!lane.insertion) return;
  delaunay_.claim(lane.lane);
  if (!watch_.empty() && lane.insertion == VertexKind::kSurface) lane.changing = box_of_change(lane.lane.star);
}

/// The ball's centre may encroach on a segment: then that is split, and the facet waits on, or the facet is left as it
/// is. What look_at_facet() is to return; none if there is no segment.
std::optional<bool> Refinement::leaves_to_features(const RefinementQueues::WaitingFacet& waiting,
                                                   const SurfaceBall& ball, RefinementLane& lane,
                                                   RefinementQueues& queues, bool alone) {
  if (!features_) return std::nullopt;
  const double size = surface_.size(ball.center);
  std::uint32_t segment = 0;
  const bool exempt = ball.squared_radius <= size * size && touches_feature(waiting.facet);
  const AtFeature at = at_feature(ball.center, exempt, segment);
  if (at == AtFeature::kClear) return std::nullopt;
  const auto leave = [&] {
    const bool alive = delaunay_.alive(waiting.facet.cell, waiting.stamp);
    const bool in_want = alive && delaunay_.bipolar(waiting.facet) && delaunay_.ball(waiting.facet) == nullptr;
    if (in_want) add_judged(lane, waiting, ball, false);
    queues.pop_facet();
  };
  if (at == AtFeature::kLeave) {
    leave();
  } else if (!alone) {
    lane.aside.facets.push_back(waiting);
    queues.pop_facet();
  } else if (!lane.judged.empty()) {
    return false;
  } else if (!budget_left() || !split_feature(segment)) {
    leave();
  }
  return true;
}

/// Asks for the cells of facets that will be looked at soon, then for those beyond.
void Refinement::prefetch_ahead(const RefinementQueues& queues) const {
  constexpr std::size_t kCells = 8, kNeighbors = 4;
  const std::size_t waiting = queues.facets_waiting();
  const auto cell = [&](std::size_t ahead) { return queues.facets[queues.next_facet + ahead].facet.cell; };
  if (kCells < waiting) delaunay_.prefetch(cell(kCells));
  if (kNeighbors < waiting) delaunay_.prefetch_neighbors(cell(kNeighbors));
}

/// The first facet waiting: leaves the queue, unless something is to be inserted for it. False if the mesh has to change
/// for it at once, which it must not before the balls judged so far are kept.
bool Refinement::look_at_facet(RefinementLane& lane, RefinementQueues& queues, Worker& worker, bool alone) {
  prefetch_ahead(queues);
  const auto waiting = queues.facets[queues.next_facet];
  const FacetId facet = waiting.facet;
  const bool may_change = alone && lane.judged.empty();
  const bool alive = delaunay_.alive(facet.cell, waiting.stamp) && may_be_restricted(facet);
  const SurfaceBall* const known = alive ? delaunay_.ball(facet) : nullptr;
  const auto ball = known != nullptr ? std::optional(*known) : alive ? find_ball(facet, *worker.oracle) : std::nullopt;
  if (!ball) {
    queues.pop_facet();
    return true;
  }
  if (has_interior_vertex(facet)) {
    if (alone && !may_change) return false;
    queues.pop_facet();
    alone ? remove_interior_vertex_of(facet) : lane.aside.facets.push_back(waiting);
    return true;
  }
  const Verdict verdict = judge(facet, *ball);
  if (verdict == Verdict::kTwoFaced) {
    lane.two_faced.push_back(waiting);
    queues.pop_facet();
    return true;
  }
  if (verdict != Verdict::kSplit) {
    if (known == nullptr) add_judged(lane, waiting, *ball, verdict == Verdict::kTooDeviant);
    queues.pop_facet();
    return true;
  }
  if (const auto done = leaves_to_features(waiting, *ball, lane, queues, alone)) return *done;
  Star& star = lane.lane.star;
  delaunay_.evaluate(ball->center, facet.cell, worker, star);
  if (star.duplicate) {
    ++lane.stuck;
    lane.stuck_place = ball->center;
    if (known == nullptr && delaunay_.bipolar(facet)) add_judged(lane, waiting, *ball, false);
    queues.pop_facet();
    return true;
  }
  lane.insertion = VertexKind::kSurface;
  lane.purpose = RefinementLane::Purpose::kFacet;
  return true;
}

void Refinement::keep(RefinementLane& lane, FacetId facet, const SurfaceBall& ball, bool too_deviant) {
  delaunay_.keep_ball(facet, ball, lane.lane);
  lane.dirty.add(delaunay_.vertices(facet));
  lane.too_deviant += too_deviant;
  if (too_deviant) lane.deviant_place = ball.center;
}

/// Does what look() has found, as far as the lane holds its claims: what it does not waits on.
void Refinement::conclude(RefinementLane& lane, RefinementQueues& queues) {
  for (const auto& [waiting, ball, too_deviant, vertices] : lane.judged) {
    if (!delaunay_.holds(vertices, lane.lane.claim)) {
      queues.facets.push_back(waiting);
    } else if (delaunay_.ball(waiting.facet) == nullptr) {  // else judged from its other side, too
      keep(lane, waiting.facet, ball, too_deviant);
    }
  }
  if (!lane.insertion || !delaunay_.holds(lane.lane)) return;
  if (lane.purpose == RefinementLane::Purpose::kUmbrella) {
    lane.radii_for_umbrellas.push_back(lane.split_radius);
    ++lane.next_umbrella;
  } else if (lane.purpose == RefinementLane::Purpose::kFacet) {
    // What sharp edges have left may be part of an umbrella without its ball.
    if (features_) lane.dirty.add(delaunay_.vertices(queues.facets[queues.next_facet].facet));
    queues.pop_facet();
  }
  const VertexId inserted = delaunay_.commit(lane.lane, *lane.insertion);
  for (const auto& triangle : lane.lane.lost) lane.dirty.add(triangle);
  const bool on_surface = lane.insertion == VertexKind::kSurface;
  if (on_surface && !watch_.empty()) lane.changes.push_back({lane.changing, inserted});
  if (lane.purpose != RefinementLane::Purpose::kUmbrella) {
    ++(on_surface ? lane.surface_insertions : lane.interior_insertions);
  }
  const std::size_t first_new = queues.facets.size();
  enqueue(lane.lane.created, oldest_stamp(lane.lane.created), queues);
  if (tet_criteria_ != nullptr) judge_new(lane, queues, first_new);
}

/// Facets from number `first` on have just been made by the lane: their balls become known before any other tet is
/// looked at, which might lie in one of them. Those that meet the criteria need not wait.
void Refinement::judge_new(RefinementLane& lane, RefinementQueues& queues, std::size_t first) {
  const Oracle& oracle = *delaunay_.worker().oracle;
  const auto is_done = [&](const RefinementQueues::WaitingFacet& waiting) {
    if (delaunay_.ball(waiting.facet) != nullptr) return false;
    const auto ball = find_ball(waiting.facet, oracle);
    if (!ball) return true;
    if (has_interior_vertex(waiting.facet)) return false;
    const Verdict verdict = judge(waiting.facet, *ball);
    if (verdict == Verdict::kTwoFaced) {
      lane.two_faced.push_back(waiting);
      return true;
    }
    keep(lane, waiting.facet, *ball, verdict == Verdict::kTooDeviant);
    return verdict != Verdict::kSplit;
  };
  auto& facets = queues.facets;
  facets.erase(std::remove_if(facets.begin() + static_cast<std::ptrdiff_t>(first), facets.end(), is_done), facets.end());
  if (queues.next_facet > 0 && queues.next_facet >= facets.size()) {
    facets.clear();
    queues.next_facet = 0;
  }
}

}  // namespace delvox
