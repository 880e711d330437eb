#pragma once

#include <cmath>
#include <numbers>

#include "delvox/core/geometry.h"

namespace delvox {

/// Of a triangle, counter-clockwise seen from where it points to; not of unit length.
inline Vector3 normal_of(const Point3& a, const Point3& b, const Point3& c) {
  return cross(b - a, c - a);
}

/// The roughness of an edge (book, 14.4), pi less its dihedral angle, from normals of its triangles that face the same
/// side.
inline double roughness_degrees(const Vector3& normal, const Vector3& other) {
  return std::atan2(norm(cross(normal, other)), dot(normal, other)) * (180 / std::numbers::pi);
}

}  // namespace delvox
