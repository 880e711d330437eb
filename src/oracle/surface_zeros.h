#pragma once

#include <vector>

#include "oracle/surface_cover.h"
#include "oracle/zero_search.h"

namespace delvox {

/// Points that were looked for, and places where it could not be decided whether there are any.
struct FoundPoints {
  std::vector<Point3> points, undecided;
};

/// Every crossing of the segment ab with the surface, in order from a. Where it touches is undecided.
FoundPoints find_crossings(const SurfaceCover& cover, const Point3& a, const Point3& b);

/// The critical points of the surface in direction d, where d is normal to it: the zeros of
///
///   h,  grad h . u,  grad h . v      with u, v orthogonal to d and to each other,
///
/// whose Jacobian (grad h; H u; H v) is regular unless the surface's curvature vanishes there in some direction.
FoundPoints find_critical_points(const SurfaceCover& cover, const Vector3& direction);

/// A part of a plane: points origin + x u + y v of the region, u and v unit vectors orthogonal to each other; all of
/// them have (x, y) in the rectangle.
struct PlanePart {
  Point3 origin;
  Vector3 u, v;
  ConvexRegion region;
  IntervalVector<2> rectangle;

  Vector3 normal() const { return cross(u, v); }
};

/// The points of the surface on a part of a plane at which the derivative of h along `direction` vanishes, that is, the
/// zeros of h and grad h . direction in x and y. Looked for within `boxes`, see SurfaceCover::critical_boxes. With a
/// direction in the plane they are the critical points of the curves in which plane and surface meet, in the direction
/// orthogonal to it (VorFacet); a point where plane and surface touch is undecided. With any other they are where the
/// silhouette meets the plane (SilhouettePlane).
FoundPoints find_critical_points(const SurfaceCover& cover, const PlanePart& part, const Vector3& direction,
                                 const std::vector<IntervalBox>& boxes, std::size_t enough);

/// The critical points in direction d' of the silhouette J_d = {h = 0, grad h . d = 0}, where the tangent of J_d is
/// orthogonal to d': the zeros of
///
///   h,  grad h . d,  det(grad h, H d, d')
///
/// that lie in the region, within `boxes` (SilhouetteCritical). The Jacobian of the third takes third derivatives of h.
FoundPoints find_silhouette_critical_points(const SurfaceCover& cover, const ConvexRegion& region, const Vector3& d,
                                            const Vector3& d_prime, const std::vector<IntervalBox>& boxes,
                                            std::size_t enough);

}  // namespace delvox
