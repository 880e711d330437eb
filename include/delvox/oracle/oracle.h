#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/core/size_field.h"

namespace delvox {

/// Points on the surface to start from, at least one set per component.
struct Seeds {
  std::vector<Point3> points;
  std::vector<std::uint32_t> component_of;  ///< of each point, from 0
  std::size_t components = 0;
};

/// Asked now and then during long work: false ends it with what there is by then. May throw to end it with nothing.
using GoOn = std::function<bool()>;
/// Never ends anything.
inline bool always_go_on() { return true; }

/// A skeleton of a domain and of its outside: points, and straight links between points of one label that do not leave
/// it. A mesh whose tets carry the labels of the points in them, and whose pieces are joined as the links say, has the
/// pieces, gaps, necks and tunnels of the domain.
struct Landmarks {
  std::vector<Point3> points;
  std::vector<std::array<std::uint32_t, 2>> links;
};

/// What a surface is up to deformation, whatever encloses what.
struct SurfaceTopology {
  std::size_t components = 0;
  long euler = 0;
  friend bool operator==(const SurfaceTopology&, const SurfaceTopology&) = default;
};

/// Sharp edges of a polygon surface.
struct FeatureEdges {
  struct Edge {
    std::array<std::uint32_t, 2> ends;  ///< of points
    std::array<Vector3, 2> into;     ///< in the planes of its two facets: unit vectors from the edge, at right angles to it
    std::array<Vector3, 2> normals;  ///< of these facets, unit vectors
    std::uint32_t component = 0;     ///< of the surface, as of seeds
  };
  std::vector<Point3> points;  ///< all different; of some no edge is sharp
  std::vector<Edge> edges;
};

/// What of a domain lies in a small box, a few voxels wide: for estimates.
struct DomainPatch {
  Point3 center;          ///< of the box, world
  double width = 0;       ///< of the box, mm, the cube root of its volume
  double inside_mm3 = 0;  ///< of the domain in it
  /// The surface in it as seen along three orthogonal axes, mm2 each: where the outside lies up the axis, and where it
  /// lies down.
  Vector3 area_up, area_down;
};

/// What the meshers ask of a domain, whatever it is made of: voxels, formulas, polygon surfaces.
/// An edge is bipolar if the labels of its two ends differ (book, 14.1.3); labels are constant on each side of the
/// surface. Queries are const but need not be thread-safe: clone() one oracle per thread.
class Oracle {
 public:
  virtual ~Oracle() = default;

  /// Box in world coordinates with the whole surface inside it; the label is 0 outside the box.
  virtual Box3 bounds() const = 0;
  /// Region at a point: 0 outside, else 1 to kLargestLabel; for an isosurface 1 inside.
  virtual Label label(const Point3& p) const = 0;
  /// A point on the surface between a and b. pre: label(a) != label(b).
  virtual Point3 intersect(const Point3& a, const Point3& b) const = 0;
  /// Every crossing of segment ab with the surface, in order from a; also of edges that are not bipolar.
  virtual std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const = 0;
  /// Points on the surface whose distances are about `size` (sparse subsets of it may be dropped, components never).
  virtual Seeds seeds(const SizeField& size, const GoOn& go_on = always_go_on) const = 0;
  /// Landmarks that a mesh as fine as `size` can be held to; none if the domain knows none, or is cut short by go_on.
  virtual Landmarks landmarks(const SizeField& size, const GoOn& go_on = always_go_on) const {
    (void)size;
    (void)go_on;
    return {};
  }
  /// The topology of the whole surface, if the domain can count it.
  virtual std::optional<SurfaceTopology> topology() const { return std::nullopt; }
  /// The edges between facets whose normals are more than `degrees` apart; none if the surface is not made of facets.
  virtual std::optional<FeatureEdges> feature_edges(double degrees) const {
    (void)degrees;
    return std::nullopt;
  }
  /// Calls visit for boxes that hold the whole domain without overlap, in one fixed order; for none if the domain
  /// cannot tell. Takes a small part of the time of seeds().
  virtual void for_each_patch(const std::function<void(const DomainPatch&)>& visit) const { (void)visit; }
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
