#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Points on the surface to start from, at least one set per component.
struct Seeds {
  std::vector<Point3> points;
  std::size_t components = 0;
};

/// Wanted distance of surface points at a place, mm.
using Spacing = std::function<double(const Point3&)>;

/// What the meshers ask of a domain, whatever it is made of: voxels, formulas, polygon surfaces.
/// An edge is bipolar if the labels of its two ends differ (book, 14.1.3); labels are constant on each side of the
/// surface. Queries are const but need not be thread-safe: clone() one oracle per thread.
class Oracle {
 public:
  virtual ~Oracle() = default;

  /// Box in world coordinates with the whole surface inside it; the label is 0 outside the box.
  virtual Box3 bounds() const = 0;
  /// Region at a point: 0 outside; for an isosurface 1 inside.
  virtual Label label(const Point3& p) const = 0;
  /// A point on the surface between a and b. pre: label(a) != label(b).
  virtual Point3 intersect(const Point3& a, const Point3& b) const = 0;
  /// Every crossing of segment ab with the surface, in order from a; also of edges that are not bipolar.
  virtual std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const = 0;
  /// Points on the surface at about the given spacing (sparse subsets of it may be dropped, components never).
  virtual Seeds seeds(const Spacing& spacing) const = 0;
  /// Points that a mesh as fine as `spacing` must have on the right side for its topology to be the domain's: a tet
  /// that contains one should carry its label. Empty if the domain knows none, or none that matter at that spacing.
  virtual std::vector<Point3> landmarks(const Spacing& spacing) const {
    (void)spacing;
    return {};
  }
  /// An independent oracle of the same domain.
  virtual std::unique_ptr<Oracle> clone() const = 0;
};

/// An oracle whose surface is the zero set of a smooth function, positive inside.
class SmoothOracle : public Oracle {
 public:
  virtual double value(const Point3& p) const = 0;
  virtual Vector3 gradient(const Point3& p) const = 0;
};

}  // namespace delvox
