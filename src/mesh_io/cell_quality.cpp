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

/// The edges at the first corners of two tets, and what both measures need of them.
struct Spokes {
  Spokes(const TetCorners& first, const TetCorners& second) {
    const PairVector origin = PairVector::of(first[0], second[0]);
    a = PairVector::of(first[1], second[1]) - origin;
    b = PairVector::of(first[2], second[2]) - origin;
    c = PairVector::of(first[3], second[3]) - origin;
    bc = cross(b, c);
    ca = cross(c, a);
    ab = cross(a, b);
    six_volumes = dot(a, bc);
  }
  PairVector a, b, c, bc, ca, ab;
  Pair six_volumes;
};

}  // namespace

Pair radius_edge_ratios(const TetCorners& first, const TetCorners& second) {
  const Spokes s(first, second);
  const Pair aa = squared_norm(s.a), bb = squared_norm(s.b), cc = squared_norm(s.c);
  Pair shortest = min(min(aa, bb), cc);
  for (const PairVector& edge : {s.b - s.a, s.c - s.b, s.a - s.c}) shortest = min(shortest, squared_norm(edge));
  const Pair ratio = norm(aa * s.bc + bb * s.ca + cc * s.ab) / (2 * abs(s.six_volumes) * sqrt(shortest));
  const Pair infinite{Box3::kInfinity, Box3::kInfinity};
  return s.six_volumes == 0 ? infinite : ratio;
}

Pair min_dihedrals_degrees(const TetCorners& first, const TetCorners& second) {
  const Spokes s(first, second);
  // Normals of the four faces, all outward or (for a negative tet) all inward.
  const Pair minus{-1, -1};
  std::array<PairVector, 4> normals{s.bc + s.ca + s.ab, minus * s.bc, minus * s.ca, minus * s.ab};
  for (PairVector& normal : normals) normal = (1 / norm(normal)) * normal;
  Pair largest_cosine = minus;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) largest_cosine = max(largest_cosine, -dot(normals[i], normals[j]));
  }
  const auto degrees = [&](int n) { return s.six_volumes[n] != 0 ? angle_of_cosine(largest_cosine[n]) : 0.0; };
  return Pair{degrees(0), degrees(1)};
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
