#include "check/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace delvox::check {
namespace {

double squared_distance_to_segment(const Point3& p, const Point3& a, const Point3& b) {
  const Vector3 d = b - a;
  const double length = squared_norm(d);
  const double t = length > 0 ? std::clamp(dot(p - a, d) / length, 0.0, 1.0) : 0;
  return squared_distance(p, a + t * d);
}

double squared_distance_to_box(const Point3& p, const Box3& box) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beyond = std::max({0.0, box.min[axis] - p[axis], p[axis] - box.max[axis]});
    sum += beyond * beyond;
  }
  return sum;
}

}  // namespace

double squared_distance_to_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 n = cross(b - a, c - a);
  const double area = squared_norm(n);
  const bool above = area > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                     dot(cross(a - c, p - c), n) >= 0;
  if (above) {
    const double height = dot(p - a, n);
    return height * height / area;
  }
  return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                   squared_distance_to_segment(p, c, a)});
}

TriangleTree::TriangleTree(const std::vector<Point3>& points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles), order_(triangles.size()) {
  std::vector<Point3> centers;
  centers.reserve(triangles.size());
  for (const Triangle& t : triangles) centers.push_back((1.0 / 3) * (points[t[0]] + points[t[1]] + points[t[2]]));
  std::iota(order_.begin(), order_.end(), 0u);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()), centers);
}

std::uint32_t TriangleTree::build(std::uint32_t begin, std::uint32_t end, const std::vector<Point3>& centers) {
  constexpr std::uint32_t kLeafSize = 4;
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, begin, end});
  Box3 box, center_box;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (std::uint32_t v : triangles_[order_[i]]) box.extend(points_[v]);
    center_box.extend(centers[order_[i]]);
  }
  nodes_[index].box = box;
  if (end - begin <= kLeafSize) return index;
  int axis = 0;
  for (int other : {1, 2}) {
    if (center_box.max[other] - center_box.min[other] > center_box.max[axis] - center_box.min[axis]) axis = other;
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b;
                   });
  build(begin, middle, centers);
  const std::uint32_t right = build(middle, end, centers);
  nodes_[index].right = right;
  return index;
}

double TriangleTree::distance(const Point3& p) const {
  struct Waiting {
    std::uint32_t node;
    double bound;
  };
  double best = std::numeric_limits<double>::infinity();
  Waiting stack[64];  // twice the depth of a median-split tree of 2^31 triangles
  int depth = 0;
  if (!nodes_.empty()) stack[depth++] = {0, 0.0};
  while (depth > 0) {
    const Waiting at = stack[--depth];
    if (at.bound >= best) continue;
    const Node& node = nodes_[at.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Triangle& t = triangles_[order_[i]];
        best = std::min(best, squared_distance_to_triangle(p, points_[t[0]], points_[t[1]], points_[t[2]]));
      }
      continue;
    }
    Waiting near{at.node + 1, squared_distance_to_box(p, nodes_[at.node + 1].box)};
    Waiting far{node.right, squared_distance_to_box(p, nodes_[node.right].box)};
    if (far.bound < near.bound) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  return std::sqrt(best);
}

}  // namespace delvox::check
