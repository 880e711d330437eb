#include "check/gradation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace delvox::check {
namespace {

constexpr std::size_t kChunk = 8192;  // tets measured together

/// Points in a tree of planes: the median along the longest side of each part's box parts it.
class PointTree {
 public:
  explicit PointTree(std::vector<Point3> points) : points_(std::move(points)), axis_(points_.size()) {
    build(0, points_.size());
  }

  /// The squared distance to the nearest point, or `within` if none is nearer than that.
  double nearest(const Point3& p, double within) const {
    search(p, 0, points_.size(), within);
    return within;
  }

 private:
  void build(std::size_t begin, std::size_t end) {
    if (end - begin < 2) return;
    Box3 box;
    for (std::size_t i = begin; i < end; ++i) box.extend(points_[i]);
    const Vector3 side = box.max - box.min;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Point3& a, const Point3& b) { return a[axis] < b[axis]; });
    axis_[middle] = static_cast<std::uint8_t>(axis);
    build(begin, middle);
    build(middle + 1, end);
  }

  void search(const Point3& p, std::size_t begin, std::size_t end, double& within) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    within = std::min(within, squared_distance(p, points_[middle]));
    if (end - begin == 1) return;
    const double beyond = p[axis_[middle]] - points_[middle][axis_[middle]];
    const bool above = beyond > 0;
    search(p, above ? middle + 1 : begin, above ? end : middle, within);
    if (beyond * beyond < within) search(p, above ? begin : middle + 1, above ? middle : end, within);
  }

  std::vector<Point3> points_;
  std::vector<std::uint8_t> axis_;
};

std::vector<Point3> nodes_of(const std::vector<Point3>& points, std::span<const Triangle> triangles) {
  std::vector<std::uint8_t> used(points.size(), 0);
  std::vector<Point3> nodes;
  for (const Triangle& t : triangles) {
    for (std::uint32_t v : t) {
      if (used[v] == 0) nodes.push_back(points[v]);
      used[v] = 1;
    }
  }
  return nodes;
}

struct Sphere {
  Point3 center;
  double radius = 0;
  double uncertainty = 0;  ///< of the place of the centre if corners move by 1
};

Sphere circumsphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Vector3 u = b - a, v = c - a, w = d - a;
  const Vector3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double six_volumes = dot(u, vw);
  const Vector3 offset =
      (0.5 / six_volumes) * (squared_norm(u) * vw + squared_norm(v) * wu + squared_norm(w) * uv);
  const double radius = norm(offset);
  // The centre solves three equations of planes, whose normals u, v, w and distances change.
  return {a + offset, radius, 4 * radius * (norm(vw) + norm(wu) + norm(uv)) / std::abs(six_volumes)};
}

}  // namespace

Extreme measure_gradation(const std::vector<Point3>& points, std::span<const Tet> tets,
                          std::span<const Triangle> boundary, const GradedBound& bound, Precision precision) {
  const PointTree nodes(nodes_of(points, boundary));
  const double at_surface = bound.size * (1 + 0.5 * bound.grade);
  const auto parts = map_chunks(tets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    Extreme worst;
    Point3 last;  // circumcentre whose depth was looked up last: depths differ by no more than places do
    double last_depth = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = tets[i];
      const Sphere sphere = circumsphere(points[t[0]], points[t[1]], points[t[2]], points[t[3]]);
      if (!(sphere.radius > at_surface)) continue;
      const double of_interest = std::min(1.0, worst.value), apart = distance(sphere.center, last);
      if (worst.any && sphere.radius <= of_interest * (at_surface + bound.grade * (last_depth - apart))) continue;
      const double farthest = worst.any ? last_depth + apart : std::numeric_limits<double>::infinity();
      const double depth = std::sqrt(nodes.nearest(sphere.center, farthest * farthest * (1 + 1e-9)));
      last = sphere.center;
      last_depth = depth;
      const double ratio = sphere.radius / (at_surface + bound.grade * depth);
      keep_largest(worst, ratio, [&] { return sphere.center; });
      const double move = sphere.uncertainty * precision.displacement_mm;
      worst.violations += ratio > 1 + 1e-9 && !(sphere.radius - move <= at_surface + bound.grade * (depth + move));
    }
    return worst;
  });
  Extreme worst;
  for (const Extreme& part : parts) append_largest(worst, part);
  return worst;
}

}  // namespace delvox::check
