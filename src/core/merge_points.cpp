#include "delvox/core/merge_points.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace delvox {

SurfaceMesh with_equal_points_merged(const SurfaceMesh& mesh, std::vector<std::uint32_t>* kept) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  const auto key = [&](std::uint32_t i) { return std::tie(mesh.points[i].x, mesh.points[i].y, mesh.points[i].z); };
  std::vector<std::uint32_t> order(mesh.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  std::vector<std::uint32_t> first(mesh.points.size());  // of the points at the same place
  for (std::size_t i = 0; i < order.size(); ++i) {
    first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
  }
  SurfaceMesh merged;
  merged.info = mesh.info;
  std::vector<std::uint32_t> renumbered(mesh.points.size(), kUnused);
  if (kept != nullptr) kept->clear();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle triangle = mesh.triangles[t];
    for (std::uint32_t& v : triangle) v = first[v];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    for (std::uint32_t& v : triangle) {
      std::uint32_t& index = renumbered[v];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(merged.points.size());
        merged.points.push_back(mesh.points[v]);
      }
      v = index;
    }
    merged.triangles.push_back(triangle);
    if (kept != nullptr) kept->push_back(t);
  }
  return merged;
}

}  // namespace delvox
