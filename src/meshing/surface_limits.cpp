#include "meshing/surface_limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshing/triangle_shape.h"

namespace delvox {
namespace {

double largest_cosine_of(const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 ab = b - a, bc = c - b, ca = a - c;
  const double lab = norm(ab), lbc = norm(bc), lca = norm(ca);
  return std::max({-dot(ab, ca) / (lab * lca), -dot(ab, bc) / (lab * lbc), -dot(bc, ca) / (lbc * lca)});
}

}  // namespace

SurfaceLimits::SurfaceLimits(const Oracle& oracle, const SurfaceCriteria& criteria)
    : oracle_(oracle),
      criteria_(criteria),
      largest_cosine_(std::cos(criteria.min_angle_degrees * std::numbers::pi / 180)) {}

bool SurfaceLimits::allows_angles(const Point3& a, const Point3& b, const Point3& c) const {
  return largest_cosine_of(a, b, c) <= largest_cosine_;
}

bool SurfaceLimits::allows(const Point3& a, const Point3& b, const Point3& c) const {
  if (!allows_angles(a, b, c)) return false;
  const auto [center, rr, n] = circumcircle(a, b, c);
  const double largest = criteria_.size.maximum();
  if (!(rr < largest * largest)) return false;
  const double reach = std::min(std::sqrt(largest * largest - rr), criteria_.max_deviation);
  const Vector3 step = (reach / norm(n)) * n;
  const Point3 below = center - step, above = center + step;
  if (criteria_.size.constant() && oracle_.label(below) != oracle_.label(above)) return true;
  for (const Point3& ball : oracle_.intersect_all(below, above)) {
    if (squared_distance(ball, a) <= criteria_.size(ball) * criteria_.size(ball)) return true;
  }
  return false;
}

std::optional<Point3> SurfaceLimits::nearest(const Point3& p, const Vector3& outward, double reach, Label label) const {
  const std::vector<Point3> found = oracle_.intersect_all(p, p + (inside(p, label) ? reach : -reach) * outward);
  return found.empty() ? std::nullopt : std::optional(found[0]);
}

std::optional<Point3> SurfaceLimits::project(const Point3& p, const Vector3& outward, double reach, Label label) const {
  const Point3 below = p - reach * outward, above = p + reach * outward;
  if (oracle_.label(below) != label || oracle_.label(above) == label) return std::nullopt;
  return oracle_.intersect(below, above);
}

}  // namespace delvox
