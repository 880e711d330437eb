#include "delaunay/spatial_order.h"

#include <CGAL/hilbert_sort.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/hash.h"

namespace delvox {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Rounds halve in size going back from the last: the last holds half of the points.
int round_of(const Point3& p, int last_round) {
  return std::max(0, last_round - std::countr_zero(hash_point(p) | (1ull << 63)));
}

}  // namespace

std::vector<Point3> in_spatial_order(const std::vector<Point3>& points) {
  std::vector<Kernel::Point_3> sorted_points;
  sorted_points.reserve(points.size());
  for (const Point3& p : points) sorted_points.emplace_back(p.x, p.y, p.z);
  const int last_round = std::max(0, static_cast<int>(std::bit_width(points.size() / 64)));
  std::vector<std::vector<std::size_t>> rounds(last_round + 1);
  for (std::size_t i = 0; i < points.size(); ++i) rounds[round_of(points[i], last_round)].push_back(i);

  using Map = CGAL::Pointer_property_map<Kernel::Point_3>::type;
  const CGAL::Spatial_sort_traits_adapter_3<Kernel, Map> traits(CGAL::make_property_map(sorted_points));
  std::vector<Point3> result;
  result.reserve(points.size());
  for (auto& round : rounds) {
    CGAL::hilbert_sort(round.begin(), round.end(), traits);
    for (std::size_t i : round) result.push_back(points[i]);
  }
  return result;
}

std::uint64_t hash_point(const Point3& p) {
  std::uint64_t h = 0;
  for (int axis = 0; axis < 3; ++axis) h = mix_hash(h ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0));
  return h;
}

}  // namespace delvox
