#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "delaunay/restricted_delaunay.h"

namespace delvox::test {

using ExactKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

inline ExactKernel::Point_3 cgal(const Point3& p) {
  return {p.x, p.y, p.z};
}

inline bool finite(const RestrictedDelaunay& delaunay, CellId cell) {
  const auto& v = delaunay.vertices(cell);
  return std::count(v.begin(), v.end(), kNone) == 0;
}

/// The sign of a tet's volume, exactly.
inline int signed_volume(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return CGAL::orientation(cgal(a), cgal(b), cgal(c), cgal(d));
}

template <class Visit>
void for_each_cell(const RestrictedDelaunay& delaunay, const Visit& visit) {
  for (CellId cell = 0; cell < delaunay.cell_capacity(); ++cell) {
    if (delaunay.stamp(cell) != 0) visit(cell);
  }
}

/// Vertices of living cells, corners left out.
inline std::size_t used_vertices(const RestrictedDelaunay& delaunay) {
  std::set<VertexId> used;
  for_each_cell(delaunay, [&](CellId c) { used.insert(delaunay.vertices(c).begin(), delaunay.vertices(c).end()); });
  used.erase(kNone);
  for (VertexId corner = 0; corner < 4; ++corner) used.erase(corner);
  return used.size();
}

/// Neighbours know each other, tets are positive, and no facet's opposite vertex lies in the sphere: by Delaunay's
/// lemma that makes the whole triangulation Delaunay. All by exact predicates.
inline void expect_delaunay(const RestrictedDelaunay& delaunay) {
  std::size_t violations = 0, flat = 0, broken = 0;
  for_each_cell(delaunay, [&](CellId cell) {
    if (!finite(delaunay, cell)) return;
    const auto& v = delaunay.vertices(cell);
    for (int i = 0; i < 4; ++i) {
      if (!finite(delaunay, delaunay.neighbors(cell)[i])) continue;
      const FacetId mirror = delaunay.mirror({cell, i});
      auto own = delaunay.vertices(FacetId{cell, i}), other = delaunay.vertices(mirror);
      std::sort(own.begin(), own.end());
      std::sort(other.begin(), other.end());
      broken += delaunay.stamp(mirror.cell) == 0 || delaunay.neighbors(mirror.cell)[mirror.index] != cell ||
                own != other;
    }
    std::array<ExactKernel::Point_3, 4> p;
    for (int i = 0; i < 4; ++i) p[i] = cgal(delaunay.point(v[i]));
    flat += CGAL::orientation(p[0], p[1], p[2], p[3]) != CGAL::POSITIVE;
    for (int i = 0; i < 4; ++i) {
      if (!finite(delaunay, delaunay.neighbors(cell)[i])) continue;
      const FacetId mirror = delaunay.mirror({cell, i});
      const auto opposite = cgal(delaunay.point(delaunay.vertices(mirror.cell)[mirror.index]));
      violations += CGAL::side_of_oriented_sphere(p[0], p[1], p[2], p[3], opposite) == CGAL::ON_POSITIVE_SIDE;
    }
  });
  EXPECT_EQ(broken, 0u) << "neighbours that do not know each other";
  EXPECT_EQ(flat, 0u) << "tets that are not positive";
  EXPECT_EQ(violations, 0u) << "facets that are not locally Delaunay";
}

/// Cached spheres and labels equal what recomputing gives.
inline void expect_true_cells(const RestrictedDelaunay& delaunay, const Oracle& oracle) {
  std::size_t tested = 0;
  for_each_cell(delaunay, [&](CellId c) {
    const Circumsphere& found = delaunay.sphere(c);
    if (!finite(delaunay, c)) {
      EXPECT_EQ(delaunay.label(c), 0);
      return;
    }
    const auto& v = delaunay.vertices(c);
    const Circumsphere sphere =
        circumsphere(delaunay.point(v[3]), delaunay.point(v[2]), delaunay.point(v[0]), delaunay.point(v[1]));
    EXPECT_LE(distance(sphere.center, found.center), 2e-9 * std::sqrt(sphere.squared_radius) + 1e-15);
    EXPECT_NEAR(found.squared_radius / sphere.squared_radius, 1, 2e-9);
    EXPECT_EQ(delaunay.label(c), oracle.label(found.center));
    for (VertexId vertex : v) {
      if (delaunay.kind(vertex) == VertexKind::kCorner) {
        EXPECT_EQ(delaunay.label(c), 0);
      }
    }
    ++tested;
  });
  EXPECT_GT(tested, 50u);
}

inline void compute_all_balls(RestrictedDelaunay& delaunay) {
  for_each_cell(delaunay, [&](CellId c) {
    for (int i = 0; i < 4; ++i) {
      if (delaunay.bipolar({c, i}) && delaunay.ball({c, i}) == nullptr) delaunay.compute_ball({c, i});
    }
  });
}

inline double distance_to_segment(const Point3& p, const Point3& a, const Point3& b) {
  const Vector3 ab = b - a;
  const double t = squared_norm(ab) > 0 ? std::clamp(dot(p - a, ab) / squared_norm(ab), 0.0, 1.0) : 0;
  return distance(p, a + t * ab);
}

/// Every ball that is kept belongs to a bipolar facet, is centred on the surface and on the facet's dual edge as it is
/// now, and, if `all_vertices`, has no vertex inside. Returns the number of balls.
inline std::size_t expect_true_balls(const RestrictedDelaunay& delaunay, const SmoothOracle& oracle,
                                     bool all_vertices) {
  std::set<VertexId> vertices;
  if (all_vertices) {
    for_each_cell(delaunay,
                  [&](CellId c) { vertices.insert(delaunay.vertices(c).begin(), delaunay.vertices(c).end()); });
    vertices.erase(kNone);
  }
  std::size_t count = 0;
  for_each_cell(delaunay, [&](CellId c) {
    for (int i = 0; i < 4; ++i) {
      if (!finite(delaunay, c) || !finite(delaunay, delaunay.neighbors(c)[i])) continue;
      const FacetId facet{c, i}, mirror = delaunay.mirror(facet);
      const SurfaceBall* ball = delaunay.ball(facet);
      EXPECT_EQ(ball, delaunay.ball(mirror));
      if (ball == nullptr) continue;
      ++count;
      EXPECT_TRUE(delaunay.bipolar(facet));
      EXPECT_NEAR(oracle.value(ball->center), 0, 1e-9);
      const Point3 a = delaunay.sphere(c).center, b = delaunay.sphere(mirror.cell).center;
      // Circumcentres of needles are right to nine digits of their own radius.
      const double tolerance = 1e-8 * (1 + distance(a, ball->center) + distance(b, ball->center));
      EXPECT_LE(distance_to_segment(ball->center, a, b), tolerance);
      for (VertexId v : delaunay.vertices(facet)) {
        EXPECT_NEAR(squared_distance(ball->center, delaunay.point(v)), ball->squared_radius, 1e-7);
      }
      for (VertexId v : vertices) {
        EXPECT_GE(squared_distance(ball->center, delaunay.point(v)), ball->squared_radius - 1e-7);
      }
    }
  });
  return count / 2;
}

}  // namespace delvox::test
