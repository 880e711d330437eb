#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "oracle/polygon_surface.h"

namespace delvox {

/// The triangles of a closed surface in a tree of boxes, for segments. What is decided is exact: where a segment meets
/// an edge or a vertex, its end is moved by an infinitesimal amount towards one of a few fixed points, so that it
/// crosses either this triangle or the other, never both nor none. May be asked by many threads at once.
class PolygonTree {
 public:
  explicit PolygonTree(const PolygonSurface& surface);
  ~PolygonTree();

  struct Crossing {
    double t;  ///< of a + t (b - a)
    std::uint32_t triangle;
    Point3 point;  ///< on the triangle, to rounding
  };
  /// Every crossing of segment ab with the surface, in order from a.
  std::vector<Crossing> crossings(const Point3& a, const Point3& b) const;

  enum class Parity { kEven, kOdd, kOnSurface };
  /// Of the number of crossings between a and b; kOnSurface if a lies on the surface. pre: b does not.
  Parity parity(const Point3& a, const Point3& b) const;

  /// Per component, whether it lies within an odd number of others.
  std::vector<bool> cavities(const PolygonSurface& surface) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delvox
