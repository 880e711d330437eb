#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/oracle/interval.h"

namespace delvox {

/// The points with normal . x <= offset.
struct HalfSpace {
  Vector3 normal;
  double offset = 0;

  double excess(const Point3& p) const { return dot(normal, p) - offset; }
};

/// An intersection of half-spaces.
using ConvexRegion = std::vector<HalfSpace>;

inline bool contains(const ConvexRegion& region, const Point3& p) {
  return std::all_of(region.begin(), region.end(), [&](const HalfSpace& half) { return half.excess(p) <= 0; });
}

/// Enclosure of normal . x over a box.
inline Interval project(const Vector3& normal, const IntervalBox& box) {
  return Interval(normal.x) * box[0] + Interval(normal.y) * box[1] + Interval(normal.z) * box[2];
}

inline bool outside(const HalfSpace& half, const IntervalBox& box) {
  return project(half.normal, box).low > half.offset;
}

/// Does the box lie outside one of the half-spaces? If not, it may still miss the region by its edges.
inline bool outside(const ConvexRegion& region, const IntervalBox& box) {
  return std::any_of(region.begin(), region.end(), [&](const HalfSpace& half) { return outside(half, box); });
}

inline Point3 middle_of(const IntervalBox& box) {
  return {box[0].middle(), box[1].middle(), box[2].middle()};
}
inline IntervalBox box_of(const Point3& p) {
  return {Interval(p.x), Interval(p.y), Interval(p.z)};
}
inline double width_of(const IntervalBox& box) {
  return std::max({box[0].width(), box[1].width(), box[2].width()});
}

}  // namespace delvox
