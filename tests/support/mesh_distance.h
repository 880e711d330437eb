#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "delvox/core/mesh.h"
#include "support/surface_measures.h"

namespace delvox::test {

/// Distance from p to triangle abc (Ericson, Real-Time Collision Detection, 5.1.5).
inline double distance_to_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return norm(ap);
  const Vector3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return norm(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(ap - (d1 / (d1 - d3)) * ab);
  const Vector3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return norm(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(ap - (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return norm(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
  const Vector3 n = cross(ab, ac);
  return std::abs(dot(n, ap)) / norm(n);
}

/// The largest distance from sample points on `from` to the surface `to`.
inline double one_sided_distance(const SurfaceMesh& from, const SurfaceMesh& to) {
  struct Bounded {
    Point3 center;
    double radius;
    const Triangle* triangle;
  };
  std::vector<Bounded> triangles;
  for (const Triangle& t : to.triangles) {
    const Point3 &a = to.points[t[0]], &b = to.points[t[1]], &c = to.points[t[2]];
    const Point3 center = (1.0 / 3) * (a + b + c);
    triangles.push_back({center, std::max({distance(center, a), distance(center, b), distance(center, c)}), &t});
  }
  // Sorted by x, so that a search can stop once triangles are too far along it.
  std::sort(triangles.begin(), triangles.end(), [](const Bounded& a, const Bounded& b) { return a.center.x < b.center.x; });
  double widest = 0;
  for (const Bounded& t : triangles) widest = std::max(widest, t.radius);
  double largest = 0;
  for_each_sample(from, 2, [&](const Point3& p) {
    double nearest = Box3::kInfinity;
    const auto middle = std::lower_bound(triangles.begin(), triangles.end(), p.x,
                                         [](const Bounded& t, double x) { return t.center.x < x; });
    const auto consider = [&](const Bounded& t) {
      if (distance(p, t.center) - t.radius >= nearest) return;
      const Triangle& v = *t.triangle;
      nearest = std::min(nearest, distance_to_triangle(p, to.points[v[0]], to.points[v[1]], to.points[v[2]]));
    };
    for (auto t = middle; t != triangles.end() && t->center.x - p.x < nearest + widest; ++t) consider(*t);
    for (auto t = middle; t != triangles.begin() && p.x - (t - 1)->center.x < nearest + widest; --t) consider(*(t - 1));
    largest = std::max(largest, nearest);
  });
  return largest;
}

inline double two_sided_distance(const SurfaceMesh& a, const SurfaceMesh& b) {
  return std::max(one_sided_distance(a, b), one_sided_distance(b, a));
}

}  // namespace delvox::test
