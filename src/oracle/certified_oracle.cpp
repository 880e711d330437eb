#include "oracle/certified_oracle.h"

#include <array>
#include <cmath>

#include "oracle/bracketed_root.h"
#include "oracle/surface_zeros.h"

namespace delvox {

double CertifiedOracle::value(const Point3& p) const {
  double h = 0;
  cover_.function().evaluate(p, 0, &h);
  return -h;
}

Vector3 CertifiedOracle::gradient(const Point3& p) const {
  std::array<double, SmoothFunction::kResults[1]> r;
  cover_.function().evaluate(p, 1, r.data());
  return {-r[1], -r[2], -r[3]};
}

/// Crossings of a bipolar edge that is crossed once are what is asked for; of others, the first.
Point3 CertifiedOracle::intersect(const Point3& a, const Point3& b) const {
  if (const FoundPoints found = find_crossings(cover_, a, b); !found.points.empty()) return found.points[0];
  // Too close to an end, or to touching, to be told apart from it.
  const Vector3 ab = b - a;
  const auto along = [&](double t) {
    const Point3 p = a + t * ab;
    return cover_.box().contains(p) ? value(p) : -std::abs(value(p));
  };
  const double at_a = along(0), at_b = along(1);
  return a + bracketed_root(along, 0, at_a, 1, at_b, std::min(std::abs(at_a), std::abs(at_b))) * ab;
}

std::vector<Point3> CertifiedOracle::intersect_all(const Point3& a, const Point3& b) const {
  return find_crossings(cover_, a, b).points;
}

Seeds CertifiedOracle::seeds(const SizeField&, const GoOn&) const {
  // Oblique to all that a formula is likely to be aligned with.
  constexpr Vector3 kDirections[] = {{0.486, 0.713, 0.505}, {-0.597, 0.352, 0.721}, {0.331, -0.829, 0.451}};
  Seeds seeds;
  for (const Vector3& direction : kDirections) {
    const FoundPoints found = find_critical_points(cover_, (1 / norm(direction)) * direction);
    seeds.points = found.points;
    if (found.undecided.empty()) break;
    const auto near = project(found.undecided[0]);
    if (seeds.points.empty() && near) seeds.points.push_back(*near);  // one is enough
  }
  return seeds;
}

std::optional<Point3> CertifiedOracle::project(const Point3& p) const {
  constexpr int kSteps = 20;
  Point3 q = p;
  Vector3 move;
  for (int step = 0; step < kSteps; ++step) {
    const Vector3 g = gradient(q);
    move = (-value(q) / squared_norm(g)) * g;
    q = q + move;
  }
  constexpr double kConverged = 1e-9;
  if (!(norm(move) < kConverged * cover_.box().diagonal()) || !cover_.box().contains(q)) return std::nullopt;
  return q;
}

}  // namespace delvox
