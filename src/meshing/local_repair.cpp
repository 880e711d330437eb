#include "meshing/local_repair.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace delvox {

double LocalRepair::repair(std::uint32_t tet) {
  const double gain = reconnect(tet);
  return gain > 0 ? gain : move_corners(tet);
}

void LocalRepair::apply(const Change& change) {
  mesh_.apply(change);
  guard_.changed(mesh_.added_triangles());
  await(mesh_.added_tets());
}

void LocalRepair::await(std::span<const std::uint32_t> tets) {
  std::copy_if(tets.begin(), tets.end(), std::back_inserter(waiting_), [&](std::uint32_t t) { return is_sliver(t); });
}

// Makes the best of the changes at the edges and faces of a tet.
double LocalRepair::reconnect(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  double best = least_gain(tet);
  const auto take = [&](double gain) {
    if (!(gain > best)) return;
    best = gain;
    std::swap(best_change_, change_);
  };
  best_change_.clear();
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) take(reconnection_.remove_edge(corners[i], corners[j], 0, change_));
  }
  for (int i = 0; i < 4; ++i) take(reconnection_.remove_faces(tet, i, 0, change_));
  if (best_change_.old_tets.empty()) return 0;
  apply(best_change_);
  ++reconnections_;
  return best;
}

double LocalRepair::move_corners(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  const double least = least_gain(tet);
  double gain = 0;
  for (std::uint32_t v : corners) {
    Point3 place;
    const double by_moving = smoothing_.improve(v, place);
    if (!(by_moving > least)) continue;
    move(v, place);
    gain += by_moving;
    if (!is_sliver(tet)) break;
  }
  return gain;
}

double LocalRepair::displace(std::uint32_t vertex, const Vector3& step) {
  Point3 place;
  const double gain = smoothing_.displace(vertex, step, place);
  if (!std::isfinite(gain)) return 0;
  move(vertex, place);
  return gain;
}

void LocalRepair::move(std::uint32_t vertex, const Point3& place) {
  mesh_.move(vertex, place);
  guard_.changed(mesh_.fan(vertex));
  ++moves_;
  await(mesh_.star(vertex));
}

}  // namespace delvox
