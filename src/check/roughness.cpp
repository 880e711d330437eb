#include "check/roughness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/incidence.h"

namespace delvox::check {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct Side {
  Vector3 normal;
  double tilt = 0;  ///< of the normal if the corners move by 1, radians, to first order
};

Side side_of(const std::vector<Point3>& points, const Triangle& t) {
  const Vector3 ab = points[t[1]] - points[t[0]], ac = points[t[2]] - points[t[0]], n = cross(ab, ac);
  const double longest = std::sqrt(std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)}));
  return {n, 2 * longest / norm(n)};
}

}  // namespace

Extreme measure_roughness(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                          const Promises& bounds, Precision precision) {
  const auto parts = map_shared_simplices<Extreme, 3>(
      points.size(), triangles, [](const Triangle& t, int i) { return edge_key(t[i], t[i == 2 ? 0 : i + 1]); },
      [&](std::span<const Incidence> edge, Extreme& worst) {
        if (edge.size() != 2) return;
        const Triangle& one = triangles[edge[0].item() / 3];
        const Side a = side_of(points, one), b = side_of(points, triangles[edge[1].item() / 3]);
        const double cosine_side = edge[0].flipped() == edge[1].flipped() ? -1 : 1;  // as if consistently oriented
        const double degrees =
            std::atan2(norm(cross(a.normal, b.normal)), cosine_side * dot(a.normal, b.normal)) * kDegrees;
        keep_largest(worst, degrees, [&] {
          const std::uint32_t from = edge[0].item() % 3, to = from == 2 ? 0 : from + 1;
          return midpoint(points[one[from]], points[one[to]]);
        });
        if (!bounds.max_roughness_degrees) return;
        const double slack = (a.tilt + b.tilt) * precision.displacement_mm * kDegrees;
        worst.violations += !(degrees <= *bounds.max_roughness_degrees * (1 + 1e-9) + slack);
      });
  Extreme worst;
  for (const Extreme& part : parts) append_largest(worst, part);
  return worst;
}

}  // namespace delvox::check
