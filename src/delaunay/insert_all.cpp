#include <algorithm>

#include "delaunay/restricted_delaunay.h"
#include "delaunay/spatial_order.h"

namespace delvox {
namespace {

/// A lane of a round: its stretch of the order, and how far it has come. The cells it made last are near there.
struct Stretch {
  Lane lane;
  std::size_t next = 0, end = 0;
};

constexpr std::size_t kFewestPointsPerLane = 64;

}  // namespace

/// One lane for each stretch of a round of the spatial order: the stretches lie apart, so that lanes seldom meet.
/// Returns the points' vertices, kNone for duplicates and for what was left when go_on() said to end.
std::vector<VertexId> RestrictedDelaunay::insert_all(const std::vector<Point3>& points, VertexKind kind,
                                                     const GoOn& go_on) {
  std::vector<VertexId> vertices(points.size(), kNone);
  const SpatialOrder order = spatial_order(points);
  std::vector<Stretch> stretches(kMostLanes);

  const auto evaluate_next = [&](Stretch& stretch) {
    Worker& own = worker();
    for (; stretch.next < stretch.end; ++stretch.next) {
      const Point3& p = points[order.indices[stretch.next]];
      delaunay_.evaluate(p, delaunay_.nearest_hint(p, stretch.lane.created), stretch.lane.star, own.search);
      if (stretch.lane.star.duplicate) continue;
      claim(stretch.lane);
      return;
    }
  };
  const auto commit_next = [&](Stretch& stretch) {
    if (stretch.next == stretch.end || !holds(stretch.lane)) return;
    vertices[order.indices[stretch.next++]] = commit_unlabelled(stretch.lane, kind);
  };

  std::size_t begin = 0;
  bool going = true;
  for (std::size_t round_end : order.round_ends) {
    const std::size_t count = round_end - begin;
    const std::size_t lanes = std::clamp<std::size_t>(count / kFewestPointsPerLane, 1, kMostLanes);
    for (std::size_t i = 0; i < lanes; ++i) {
      stretches[i].next = begin + count * i / lanes;
      stretches[i].end = begin + count * (i + 1) / lanes;
    }
    const auto for_each_lane = [&](const auto& visit) {
      team_.for_each(lanes, [&](std::size_t i) { visit(stretches[i]); });
    };
    bool left = true;
    while (left && (going = going && go_on())) {
      const std::uint32_t first_claim = new_claims();
      for (std::size_t i = 0; i < lanes; ++i) stretches[i].lane.claim = first_claim + static_cast<std::uint32_t>(i);
      for_each_lane(evaluate_next);
      for (std::size_t i = 0; i < lanes; ++i) {
        if (stretches[i].next < stretches[i].end) furnish(stretches[i].lane, true, 0);
      }
      for_each_lane(commit_next);
      left = std::any_of(stretches.begin(), stretches.begin() + static_cast<std::ptrdiff_t>(lanes),
                         [](const Stretch& stretch) { return stretch.next < stretch.end; });
    }
    begin = round_end;
  }
  lane_.lost.clear();
  for (Stretch& stretch : stretches) {
    lane_.lost.insert(lane_.lost.end(), stretch.lane.lost.begin(), stretch.lane.lost.end());
    clear_out(stretch.lane);
  }
  return vertices;
}

}  // namespace delvox
