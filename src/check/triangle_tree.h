#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox::check {

double squared_distance_to_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c);

/// Triangles in a tree of boxes, split at the median of the longest side. Keeps references to points and triangles.
class TriangleTree {
 public:
  TriangleTree(const std::vector<Point3>& points, std::span<const Triangle> triangles);

  /// Distance to the nearest triangle; infinity if there is none.
  double distance(const Point3& p) const;

  /// Calls visit(triangle) for every triangle whose box meets `box`.
  template <class Visit>
  void for_each_in(const Box3& box, const Visit& visit) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t begin, end;  // of order_
    std::uint32_t right = 0;   // the left child follows its parent; 0: a leaf
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end, const std::vector<Point3>& centers);

  const std::vector<Point3>& points_;
  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

template <class Visit>
void TriangleTree::for_each_in(const Box3& box, const Visit& visit) const {
  const auto meets = [&box](const Box3& other) {
    for (int axis = 0; axis < 3; ++axis) {
      if (other.max[axis] < box.min[axis] || other.min[axis] > box.max[axis]) return false;
    }
    return true;
  };
  std::uint32_t stack[64];
  int depth = 0;
  if (!nodes_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Node& node = nodes_[at];
    if (!meets(node.box)) continue;
    if (node.right != 0) {
      stack[depth++] = node.right;
      stack[depth++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      Box3 own;
      for (std::uint32_t v : triangles_[order_[i]]) own.extend(points_[v]);
      if (meets(own)) visit(order_[i]);
    }
  }
}

}  // namespace delvox::check
