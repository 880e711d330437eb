#include "mesh_io/triangulate_polygon.h"

namespace delvox::mesh_io {
namespace {

// Cutting ears takes up to cubic time: a crafted file must not keep us busy for hours.
constexpr std::size_t kMostCornersForEars = 256;

/// Newell's normal: right for any polygon, even if its first corner is reflex or it is not quite plane.
Vector3 normal_of(std::span<const std::uint32_t> corners, std::span<const Point3> points) {
  Vector3 normal;
  const Point3& origin = points[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal = normal + cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
  }
  return normal;
}

/// Twice the signed area of abc as seen against `normal`.
double turn(const Point3& a, const Point3& b, const Point3& c, const Vector3& normal) {
  return dot(cross(b - a, c - a), normal);
}

bool is_ear(std::span<const std::uint32_t> corners, std::span<const Point3> points, std::size_t tip,
            const Vector3& normal) {
  const std::size_t n = corners.size();
  const std::size_t before = (tip + n - 1) % n, after = (tip + 1) % n;
  const Point3 &a = points[corners[before]], &b = points[corners[tip]], &c = points[corners[after]];
  if (turn(a, b, c, normal) <= 0) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == before || i == tip || i == after) continue;
    const Point3& p = points[corners[i]];
    if (turn(a, b, p, normal) >= 0 && turn(b, c, p, normal) >= 0 && turn(c, a, p, normal) >= 0) return false;
  }
  return true;
}

/// Area without direction: of a bow tie, where the halves cancel. Corners all in one line have neither.
bool cancels_out(std::span<const std::uint32_t> corners, std::span<const Point3> points, const Vector3& normal) {
  const std::size_t n = corners.size();
  double turned = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point3& b = points[corners[(i + 1) % n]];
    turned += norm(cross(b - points[corners[i]], points[corners[(i + 2) % n]] - b));
  }
  return norm(normal) < 1e-12 * turned;
}

/// What is no more than this part of a polygon's area is rounding.
constexpr double kFlat = 1e-12;

/// Every corner turns the same way, and every triangle of a fan too (which a pentagram fails). Corners in line with
/// their neighbours may seem to turn the other way by rounding.
bool is_convex(std::span<const std::uint32_t> corners, std::span<const Point3> points, const Vector3& normal) {
  const std::size_t n = corners.size();
  const double least = -kFlat * squared_norm(normal);
  for (std::size_t i = 0; i < n; ++i) {
    const Point3 &a = points[corners[i]], &b = points[corners[(i + 1) % n]], &c = points[corners[(i + 2) % n]];
    if (turn(a, b, c, normal) < least || turn(points[corners[0]], a, b, normal) < least) return false;
  }
  return true;
}

/// The fan around corner `tip`; nothing if a triangle of it would be flat, for corners that lie in line.
std::vector<Triangle> fan_around(std::span<const std::uint32_t> corners, std::span<const Point3> points,
                                 std::size_t tip, const Vector3& normal) {
  const std::size_t n = corners.size();
  std::vector<Triangle> fan;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Triangle t{corners[tip], corners[(tip + i) % n], corners[(tip + i + 1) % n]};
    if (n > 3 && turn(points[t[0]], points[t[1]], points[t[2]], normal) <= kFlat * squared_norm(normal)) return {};
    fan.push_back(t);
  }
  return fan;
}

/// Rather not one that holds all the area and leaves corners in line. The number of corners if there is none.
std::size_t find_ear(std::span<const std::uint32_t> corners, std::span<const Point3> points, const Vector3& normal) {
  const std::size_t n = corners.size();
  const double all = dot(normal_of(corners, points), normal);
  std::size_t found = n;
  for (std::size_t tip = 0; tip < n; ++tip) {
    if (!is_ear(corners, points, tip, normal)) continue;
    const Point3 &a = points[corners[(tip + n - 1) % n]], &b = points[corners[tip]], &c = points[corners[(tip + 1) % n]];
    const double area = turn(a, b, c, normal);
    if (area > kFlat * squared_norm(normal) && area < all - kFlat * squared_norm(normal)) return tip;
    if (found == n) found = tip;
  }
  return found;
}

}  // namespace

std::optional<std::vector<Triangle>> triangulate_polygon(std::span<const std::uint32_t> corners,
                                                         std::span<const Point3> points) {
  if (corners.size() < 3) return std::nullopt;
  const Vector3 normal = normal_of(corners, points);
  if (corners.size() > 3 && cancels_out(corners, points, normal)) return std::nullopt;
  if (corners.size() == 3 || is_convex(corners, points, normal)) {
    for (std::size_t tip = 0; tip < corners.size(); ++tip) {
      if (auto fan = fan_around(corners, points, tip, normal); !fan.empty()) return fan;
    }
  }
  if (corners.size() > kMostCornersForEars) return std::nullopt;
  std::vector<Triangle> result;
  std::vector<std::uint32_t> left(corners.begin(), corners.end());
  while (left.size() > 3) {
    const std::size_t n = left.size(), tip = find_ear(left, points, normal);
    if (tip == n) return std::nullopt;
    result.push_back({left[(tip + n - 1) % n], left[tip], left[(tip + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(tip));
  }
  result.push_back({left[0], left[1], left[2]});
  return result;
}

}  // namespace delvox::mesh_io
