#include "delvox/core/sharp_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace delvox {
namespace {

struct Side {
  Edge ends;
  std::uint32_t triangle;
  bool upward;  // the triangle runs from the lower number to the higher
};

Vector3 normal_of(const std::vector<Point3>& points, const Triangle& t) {
  return cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

}  // namespace

std::vector<SharpEdge> sharp_edges(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                   double degrees) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, t, a < b});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.ends, a.triangle) < std::tie(b.ends, b.triangle); });
  std::vector<SharpEdge> result;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].ends == sides[begin].ends) ++end;
    if (end - begin != 2) continue;
    const Side &one = sides[begin], &other = sides[begin + 1];
    const Vector3 m = normal_of(points, triangles[one.triangle]), n = normal_of(points, triangles[other.triangle]);
    const double same_side = one.upward == other.upward ? -1 : 1;
    const double angle = std::atan2(norm(cross(m, n)), same_side * dot(m, n)) * 180 / std::numbers::pi;
    if (angle > degrees) result.push_back({one.ends, {one.triangle, other.triangle}});
  }
  return result;
}

}  // namespace delvox
