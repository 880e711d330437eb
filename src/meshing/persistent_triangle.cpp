#include "meshing/persistent_triangle.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"

namespace delvox {
namespace {

/// Ball B(x, radius) of the surface, as a place to pick points from.
class SurfacePatch {
 public:
  SurfacePatch(const Oracle& oracle, const Point3& x, double radius, RandomStream& random)
      : oracle_(oracle), x_(x), radius_(radius), random_(random) {}

  /// A crossing of a random chord of the ball, if it has one.
  std::optional<Point3> pick() {
    const Point3 a = point_in_ball(), b = point_in_ball();
    std::vector<Point3> crossings = oracle_.intersect_all(a, b);
    if (crossings.empty()) return std::nullopt;
    const double last = static_cast<double>(crossings.size());
    return crossings[static_cast<std::size_t>(random_.uniform() * last)];
  }

  /// Whether the surface in the ball meets the dual line of a triangle, and its corners are well apart.
  bool accepts(const std::array<Point3, 3>& t) const {
    constexpr double kLeastSine = 0.2, kLeastEdge = 0.1;
    const Vector3 u = t[1] - t[0], v = t[2] - t[0], n = cross(u, v);
    const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(u - v), nn = squared_norm(n);
    const double shortest = std::min({uu, vv, ww}), longest_two = uu * vv * ww / std::min({uu, vv, ww});
    if (!(shortest > kLeastEdge * kLeastEdge * radius_ * radius_)) return false;
    if (!(nn > kLeastSine * kLeastSine * longest_two)) return false;
    const Point3 center = t[0] + (0.5 / nn) * (uu * cross(v, n) + vv * cross(n, u));
    const Vector3 along = (1 / std::sqrt(nn)) * n;
    // Where the dual line is nearest to x, and how far from there it stays in the ball.
    const Point3 middle = center + dot(x_ - center, along) * along;
    const double squared_half = radius_ * radius_ - squared_distance(middle, x_);
    if (!(squared_half > 0)) return false;
    const Vector3 half = std::sqrt(squared_half) * along;
    return !oracle_.intersect_all(middle - half, middle + half).empty();
  }

 private:
  Point3 point_in_ball() {
    for (;;) {
      const double x = 2 * random_.uniform() - 1, y = 2 * random_.uniform() - 1, z = 2 * random_.uniform() - 1;
      if (x * x + y * y + z * z <= 1) return x_ + radius_ * Vector3{x, y, z};
    }
  }

  const Oracle& oracle_;
  const Point3& x_;
  double radius_;
  RandomStream& random_;
};

}  // namespace

double RandomStream::uniform() {
  state_ = mix_hash(state_);
  return unit_interval(mix_hash(state_ ^ 0x5bf03635f0935ad1ull));
}

std::optional<std::array<Point3, 3>> find_persistent_triangle(const Oracle& oracle, const Point3& x, double size,
                                                              RandomStream& random) {
  constexpr int kPicks = 300;
  constexpr double kSmallest = 1e-6;  // of the domain: circumcentres of smaller triangles have too few digits
  const double extent = oracle.bounds().diagonal();
  for (double radius = std::min(size / 7, extent); radius > kSmallest * extent; radius /= 2) {
    SurfacePatch patch(oracle, x, radius, random);
    std::array<Point3, 3> triangle;
    int corners = 0;
    for (int pick = 0; pick < kPicks; ++pick) {
      const auto corner = patch.pick();
      if (!corner) continue;
      triangle[corners++] = *corner;
      if (corners < 3) continue;
      if (patch.accepts(triangle)) return triangle;
      corners = 0;
    }
  }
  return std::nullopt;
}

}  // namespace delvox
