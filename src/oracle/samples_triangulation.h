#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// The Delaunay triangulation of points that stay where they are, flat, for questions of where a point or segment lies:
/// decided by exact predicates, and by the question alone, whatever was asked before. May be asked by many threads.
class SampleTriangulation {
 public:
  /// Of four vertices, positive; neighbour i lies opposite vertex i. Beyond each facet of the convex hull lies an
  /// infinite cell: its first three vertices are the facet's, counter-clockwise seen from outside, its last is none.
  struct Cell {
    std::array<std::uint32_t, 4> vertices, neighbors;
  };
  static constexpr std::uint32_t kNone = ~0u;

  /// Throws InputError unless there are four points that do not lie in one plane. pre: no two equal.
  explicit SampleTriangulation(std::vector<Point3> points);

  const std::vector<Point3>& points() const { return points_; }
  const Box3& box() const { return box_; }
  /// The finite cells come first.
  const std::vector<Cell>& cells() const { return cells_; }
  std::uint32_t finite_count() const { return finite_count_; }
  bool finite(std::uint32_t cell) const { return cell < finite_count_; }
  const Point3& corner(std::uint32_t cell, int i) const { return points_[cells_[cell].vertices[i]]; }
  double six_volumes(std::uint32_t cell) const;

  /// A finite cell that holds p, its boundary included; or an infinite one whose facet p lies strictly beyond.
  std::uint32_t locate(const Point3& p) const;

  /// A part of a segment ab that lies in one finite cell, by its ends as shares of ab.
  struct Stretch {
    std::uint32_t cell;
    double from, to;
  };
  /// What of a segment lies in the convex hull, in order.
  struct Passage {
    std::vector<Stretch> stretches;  ///< empty: nothing
    bool starts_inside = false;      ///< a lies in the hull
    bool ends_inside = false;        ///< b does
  };
  Passage passage(const Point3& a, const Point3& b) const;

  /// Whether p lies strictly inside the circumsphere of a cell; of an infinite one: strictly beyond its facet, or in
  /// its plane and circumcircle. Exact.
  bool in_conflict(std::uint32_t cell, const Point3& p) const;

 private:
  void make_starts();
  std::uint32_t walk_to(const Point3& p, std::uint32_t start) const;
  std::uint32_t entry(std::uint32_t infinite_cell, const Point3& a, const Point3& b) const;
  int exit_face(std::uint32_t cell, std::uint32_t came_from, const Point3& a, const Point3& b) const;
  double share_at_face(std::uint32_t cell, const std::array<int, 3>& face, const Point3& a, const Point3& b) const;
  std::size_t bin_of(const Point3& p) const;

  std::vector<Point3> points_;
  Box3 box_;
  std::vector<Cell> cells_;
  std::uint32_t finite_count_ = 0;
  std::array<std::size_t, 3> bins_{1, 1, 1};  // of a grid over the box
  Vector3 bins_per_mm_;
  std::vector<std::uint32_t> starts_;  // a finite cell at or near the centre of each bin: where walks begin
};

}  // namespace delvox
