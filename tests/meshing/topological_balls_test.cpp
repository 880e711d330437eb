#include "meshing/topological_balls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "delvox/oracle/formula.h"
#include "meshing/voronoi_faces.h"
#include "support/random.h"
#include "support/smooth_formulas.h"

namespace delvox {
namespace {

using test::kBox, test::kSphere, test::kTorus, test::kTwoSheets;

/// Vor S of some sites on the surface of a formula.
class Sites {
 public:
  Sites(const char* formula, const std::vector<Point3>& points)
      : function_(make_smooth_function(Formula(formula))),
        cover_(*function_, kBox),
        oracle_(cover_),
        delaunay_(oracle_) {
    delaunay_.insert_seeds(points);
    for (VertexId v = 0; v < delaunay_.vertex_capacity(); ++v) {
      if (delaunay_.kind(v) == VertexKind::kSurface) vertices_.push_back(v);
    }
    EXPECT_EQ(vertices_.size(), points.size());
  }

  TopologicalBalls balls() { return TopologicalBalls(delaunay_, cover_, oracle_); }
  double value(const Point3& p) const { return oracle_.value(p); }
  const RestrictedDelaunay& delaunay() const { return delaunay_; }
  const std::vector<VertexId>& vertices() const { return vertices_; }
  double distance_to_sites(const Point3& p) const {
    double least = Box3::kInfinity;
    for (VertexId v : vertices_) least = std::min(least, distance(p, delaunay_.point(v)));
    return least;
  }

  /// Points that a subroutine returns for all edges, vertices, pairs or cells.
  std::vector<Point3> of_edges() {
    TopologicalBalls balls = this->balls();
    std::vector<Point3> found;
    for (CellId cell = 1; cell < delaunay_.cell_capacity(); ++cell) {
      if (delaunay_.stamp(cell) == 0) continue;
      for (int i = 0; i < 4; ++i) {
        const auto v = delaunay_.vertices(FacetId{cell, i});
        const bool real =
            std::none_of(v.begin(), v.end(), [&](VertexId p) { return delaunay_.kind(p) == VertexKind::kCorner; });
        if (!real) continue;
        if (const auto x = balls.vor_edge({cell, i})) found.push_back(*x);
      }
    }
    return found;
  }
  template <class Diagnose>
  std::vector<Point3> of_vertices(const Diagnose& diagnose) {
    TopologicalBalls balls = this->balls();
    std::vector<Point3> found;
    for (VertexId p : vertices_) {
      if (const auto x = diagnose(balls, p)) found.push_back(*x);
    }
    EXPECT_TRUE(balls.unmet().empty());
    return found;
  }
  std::vector<Point3> of_disks() {
    return of_vertices([](TopologicalBalls& balls, VertexId p) { return balls.topo_disk(p); });
  }
  std::vector<Point3> of_cells() {
    return of_vertices([](TopologicalBalls& balls, VertexId p) { return balls.silhouette(p); });
  }
  std::vector<Point3> of_facets() {
    return of_vertices([this](TopologicalBalls& balls, VertexId p) -> std::optional<Point3> {
      for (VertexId q : voronoi_neighbors(delaunay_, p)) {
        if (const auto x = balls.vor_facet(p, q)) return x;
      }
      return std::nullopt;
    });
  }

 private:
  std::unique_ptr<SmoothFunction> function_;
  SurfaceCover cover_;
  CertifiedOracle oracle_;
  RestrictedDelaunay delaunay_;
  std::vector<VertexId> vertices_;
};

/// About evenly spread over the unit sphere, irregular enough.
std::vector<Point3> spread(int count, double radius) {
  std::vector<Point3> points;
  test::Random random(7);
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count,
                 angle = i * std::numbers::pi * (3 - std::sqrt(5)) + random.between(0, 0.05);
    const double r = std::sqrt(1 - z * z);
    points.push_back({radius * r * std::cos(angle), radius * r * std::sin(angle), radius * z});
  }
  return points;
}

std::vector<Point3> on_torus(int around, int across) {
  std::vector<Point3> points;
  test::Random random(8);
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * (i + random.between(0, 0.2)) / around;
      const double v = 2 * std::numbers::pi * (j + 0.5 * (i % 2) + random.between(0, 0.2)) / across;
      const double r = 1 + 0.3 * std::cos(v);
      points.push_back({r * std::cos(u), r * std::sin(u), 0.3 * std::sin(v)});
    }
  }
  return points;
}

void expect_on_surface(const Sites& sites, const std::vector<Point3>& points) {
  for (const Point3& p : points) EXPECT_NEAR(sites.value(p), 0, 1e-9);
}

void expect_no_violation(const char* formula, const std::vector<Point3>& points) {
  Sites sites(formula, points);
  EXPECT_TRUE(sites.of_edges().empty());
  EXPECT_TRUE(sites.of_disks().empty());
  EXPECT_TRUE(sites.of_facets().empty());
  EXPECT_TRUE(sites.of_cells().empty());
}

TEST(TopologicalBalls, ADenseSampleViolatesNothing) {
  expect_no_violation(kSphere, spread(60, 1));
  expect_no_violation(kTorus, on_torus(24, 9));
  std::vector<Point3> both = spread(400, 1);
  for (const Point3& p : spread(560, 1.2)) both.push_back(p);
  expect_no_violation(kTwoSheets, both);
}

TEST(TopologicalBalls, VorEdgeFindsEdgesThatMeetTwoSheets) {
  // With sites on one sheet only, every edge that crosses that crosses the other too.
  Sites sites(kTwoSheets, spread(60, 1));
  const std::vector<Point3> found = sites.of_edges();
  EXPECT_FALSE(found.empty());
  expect_on_surface(sites, found);
  for (const Point3& p : found) EXPECT_NEAR(norm(p), 1.2, 1e-9);  // the crossing farthest from the sites
}

TEST(TopologicalBalls, VorFacetFindsALoop) {
  // Two sites at the poles: their facet cuts the sphere in its equator, and no edge is near.
  Sites sites(kSphere, {{0, 0, 1}, {0, 0, -1}});
  EXPECT_TRUE(sites.of_edges().empty());
  EXPECT_TRUE(sites.of_disks().empty());
  const std::vector<Point3> found = sites.of_facets();
  ASSERT_EQ(found.size(), 2u);
  expect_on_surface(sites, found);
  for (const Point3& p : found) EXPECT_NEAR(p.z, 0, 1e-9);
}

TEST(TopologicalBalls, VorFacetFindsATangentialContact) {
  // The facet between sites on two balls, the plane x = 0, touches a third.
  Sites sites("((x+1)^2+y^2+z^2-0.09)*((x-1)^2+y^2+z^2-0.09)*((x-0.4)^2+(y-1)^2+z^2-0.16)",
              {{-1.3, 0, 0}, {1.3, 0, 0}});
  const std::vector<Point3> found = sites.of_facets();
  ASSERT_EQ(found.size(), 2u);
  expect_on_surface(sites, found);
  for (const Point3& p : found) EXPECT_LT(distance(p, {0, 1, 0}), 1e-2);
}

TEST(TopologicalBalls, SilhouetteFindsAComponentWithinACell) {
  // All sites on one of two balls: the other lies within the cells of some.
  const char* const balls = "min((x-0.9)^2+y^2+z^2-0.25,(x+0.9)^2+y^2+z^2-0.04)";
  std::vector<Point3> points;
  for (const Point3& p : spread(40, 0.5)) points.push_back(p + Point3{0.9, 0, 0});
  Sites sites(balls, points);
  const std::vector<Point3> found = sites.of_cells();
  EXPECT_FALSE(found.empty());
  expect_on_surface(sites, found);
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Point3& p) { return p.x < 0; }));
}

TEST(TopologicalBalls, SilhouetteFindsTheWholeSurfaceInOneCell) {
  Sites sites(kSphere, {{0, 0, 1}});
  EXPECT_TRUE(sites.of_disks().empty());
  const std::vector<Point3> found = sites.of_cells();
  ASSERT_EQ(found.size(), 1u);
  expect_on_surface(sites, found);
  EXPECT_NEAR(found[0].z, 0, 0.05);  // where the normal is across that of the site
}

TEST(TopologicalBalls, TopoDiskFindsWhatIsNoDisk) {
  // Sites on the torus too sparse for its tube: edges may be crossed once each, but some umbrellas are no disks.
  std::size_t times = 0;
  for (int around = 4; around <= 9; ++around) {
    for (int across = 2; across <= 4; ++across) {
      Sites sites(kTorus, on_torus(around, across));
      if (!sites.of_edges().empty()) continue;
      const std::vector<Point3> found = sites.of_disks();
      times += !found.empty();
      expect_on_surface(sites, found);
      for (const Point3& p : found) EXPECT_GE(sites.distance_to_sites(p), 0.09 * 0.3);
    }
  }
  EXPECT_GT(times, 0u);
}

TEST(TopologicalBalls, WhatIsReturnedIsFarFromTheSites) {
  // Proposition 14.6: at least 0.09 times the least local feature size, which is 1 on the sphere, 0.3 on the torus.
  test::Random random(9);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Point3> points;
    for (int i = 0; i < 4 + trial; ++i) points.push_back(random.direction());
    Sites sites(kSphere, points);
    std::vector<Point3> found = sites.of_edges();
    if (found.empty()) found = sites.of_disks();
    if (found.empty()) found = sites.of_facets();
    if (found.empty()) found = sites.of_cells();
    expect_on_surface(sites, found);
    for (const Point3& p : found) EXPECT_GE(sites.distance_to_sites(p), 0.09);
  }
}

TEST(VoronoiFaces, FacetsAndCellsAreThosePointsThatAreNearest) {
  Sites sites(kTorus, on_torus(10, 4));
  const RestrictedDelaunay& delaunay = sites.delaunay();
  test::Random random(10);
  std::size_t in_facets = 0;
  for (VertexId p : sites.vertices()) {
    const ConvexRegion cell = voronoi_cell(delaunay, p, 0);
    for (int trial = 0; trial < 50; ++trial) {
      const Point3 x = random.in(kBox);
      EXPECT_EQ(contains(cell, x), distance(x, delaunay.point(p)) <= sites.distance_to_sites(x));
    }
    for (VertexId q : voronoi_neighbors(delaunay, p)) {
      const auto g = voronoi_facet(delaunay, p, q, kBox, 1e-9);
      if (!g) continue;
      for (int trial = 0; trial < 20; ++trial) {
        const double s = random.between(g->rectangle[0].low, g->rectangle[0].high);
        const double t = random.between(g->rectangle[1].low, g->rectangle[1].high);
        const Point3 x = g->origin + s * g->u + t * g->v;
        EXPECT_NEAR(distance(x, delaunay.point(p)), distance(x, delaunay.point(q)), 1e-9);
        const bool nearest = distance(x, delaunay.point(p)) <= sites.distance_to_sites(x) + 1e-9;
        EXPECT_EQ(contains(g->region, x), nearest && kBox.contains(x));
        in_facets += nearest;
      }
    }
  }
  EXPECT_GT(in_facets, 100u);
}

}  // namespace
}  // namespace delvox
