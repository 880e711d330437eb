#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "delvox/oracle/oracle.h"
#include "delvox/oracle/smooth_function.h"
#include "oracle/convex_region.h"

namespace delvox {

/// An octree of boxes that hold the whole zero set of a function inside a box, each with enclosures of value and
/// gradient: where no leaf is, there is certainly no surface. In every leaf the function is smooth, and the normals of
/// the surface stay within 90 degrees of each other (the small normal variation of Plantinga and Vegter, Isotopic
/// approximation of implicit curves and surfaces, 2004), so that the surface is regular. Questions divide leaves
/// further where they need to, and what they find is there for the next question. Not thread-safe.
class SurfaceCover {
 public:
  struct Node {
    IntervalBox box;
    Interval value;
    IntervalBox gradient;
    std::uint32_t first_child = 0;
    std::uint8_t children = 0;
    bool leaf = true;
    bool smooth = false;
  };

  /// The function must outlive this. Throws OptionError, with the place, if the surface may reach the border of the
  /// box, or if it may have a kink or a point without a normal somewhere, down to 1e-6 of the box's diagonal.
  /// `go_on` is asked now and then; its answer is not heeded, but it may throw.
  SurfaceCover(const SmoothFunction& function, const Box3& box, const GoOn& go_on = always_go_on);

  const SmoothFunction& function() const { return function_; }
  const Box3& box() const { return box_; }
  /// Is there certainly no surface?
  bool empty() const { return empty_; }
  /// Boxes are not divided below this width.
  double smallest_width() const { return smallest_; }

  /// Boxes that hold every point of the surface in a region at which the derivative along `direction` vanishes; none
  /// wider than `share` of its distance from `from`, unless there are `most` already.
  std::vector<IntervalBox> critical_boxes(const ConvexRegion& region, const Vector3& direction, const Point3& from,
                                          double share, std::size_t most);

  /// Boxes that hold every point of the surface at which the derivatives along both directions vanish.
  std::vector<IntervalBox> critical_boxes(const Vector3& u, const Vector3& v) const;

  /// Pieces of the segment ab, as intervals of [0, 1] from a to b, in order and apart from each other, that hold every
  /// crossing with the surface.
  std::vector<Interval> crossed_pieces(const Point3& a, const Point3& b) const;

 private:
  struct CriticalSearch;

  Node make_node(const IntervalBox& box) const;
  bool regular(const Node& node) const;
  void build(const GoOn& go_on);
  void divide(std::uint32_t number);
  void collect(std::uint32_t number, const ConvexRegion& region, CriticalSearch& search);

  const SmoothFunction& function_;
  Box3 box_;
  double smallest_ = 0;
  bool empty_ = true;
  std::deque<Node> nodes_;
};

}  // namespace delvox
