#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delvox/core/size_field.h"
#include "delvox/oracle/oracle.h"
#include "meshing/surface_clusters.h"

namespace delvox {

/// The distance from the surface, for places in a domain: an octree whose leaves are about as large as `resolution`, or
/// half as large as they lie deep, if that is more. Its memory follows the surface.
///
/// With power(p) = min over samples of |p - sample|^2 - reach^2, which is a squared distance that is hardly ever too
/// large, power(p) - |p|^2 is concave and piecewise linear: interpolated within a leaf, it is never above the truth, and
/// exact where one sample is nearest to the whole leaf. Not in the book.
class DepthTree {
 public:
  /// pre: samples lie on the oracle's surface.
  DepthTree(const Oracle& oracle, std::span<const SurfaceSample> samples, const SizeField& resolution);

  /// mm; 0 outside the oracle's bounds and where the whole leaf is outside.
  double operator()(const Point3& p) const;
  /// No place has more.
  double maximum() const { return maximum_; }

 private:
  struct Part;
  class Builder;
  /// At the corners, bit 0 of the index along x: power - |corner - centre|^2.
  using Leaf = std::array<float, 8>;
  /// From 0 on the number of the first of eight children; ~number of a leaf; or kOutside.
  using Node = std::int32_t;
  static constexpr Node kOutside = INT32_MIN;

  void graft(const Part& part, std::size_t node);

  Point3 center_;
  double half_ = 0;  // of the root's edge
  double maximum_ = 0;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace delvox
