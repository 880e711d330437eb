#include "mesh_io/cell_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace delvox::mesh_io {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

double angle_of_cosine(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegrees;
}

}  // namespace

double radius_edge_ratio(const std::array<Point3, 4>& p) {
  const Vector3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double volume6 = dot(a, bc);
  if (!(volume6 != 0)) return Box3::kInfinity;
  const double a2 = squared_norm(a), b2 = squared_norm(b), c2 = squared_norm(c);
  const double shortest2 =
      std::min({a2, b2, c2, squared_distance(p[1], p[2]), squared_distance(p[2], p[3]), squared_distance(p[3], p[1])});
  return norm(a2 * bc + b2 * ca + c2 * ab) / (2 * std::abs(volume6) * std::sqrt(shortest2));
}

double min_dihedral_degrees(const std::array<Point3, 4>& p) {
  const Vector3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  if (!(dot(a, bc) != 0)) return 0;
  // Normals of the four faces, all outward or (for a negative tet) all inward.
  std::array<Vector3, 4> normals{bc + ca + ab, -1.0 * bc, -1.0 * ca, -1.0 * ab};
  for (Vector3& normal : normals) normal = (1.0 / norm(normal)) * normal;
  double largest_cosine = -1;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) largest_cosine = std::max(largest_cosine, -dot(normals[i], normals[j]));
  }
  return angle_of_cosine(largest_cosine);
}

double min_angle_degrees(const std::array<Point3, 3>& p) {
  double largest_cosine = -1;
  for (int i = 0; i < 3; ++i) {
    const Vector3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
    const double lengths = norm(u) * norm(v);
    if (!(lengths > 0)) return 0.0;
    largest_cosine = std::max(largest_cosine, dot(u, v) / lengths);
  }
  return angle_of_cosine(largest_cosine);
}

}  // namespace delvox::mesh_io
