#include "delvox/oracle/polygon_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

SurfaceMesh cube(int n = 1, double h = 1, Point3 origin = {}) {
  return boundary_surface(test::cube_mesh(n, h, origin));
}

Label in_unit_cube(const Point3& p) {
  return p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1 && p.z >= 0 && p.z <= 1 ? 1 : 0;
}

TEST(PolygonOracle, LabelsOfACubeAreRightOnItsFacesEdgesAndLinesThroughThem) {
  // Eighths from -1/4 to 5/4: corners, edges, diagonals of faces, and lines through any number of them.
  for (int n : {1, 2, 4}) {
    const auto oracle = make_polygon_oracle(cube(n, 1.0 / n));
    Point3 p;
    for (p.x = -0.25; p.x <= 1.25; p.x += 0.125) {
      for (p.y = -0.25; p.y <= 1.25; p.y += 0.125) {
        for (p.z = -0.25; p.z <= 1.25; p.z += 0.125) {
          ASSERT_EQ(oracle->label(p), in_unit_cube(p)) << p.x << ' ' << p.y << ' ' << p.z << " of " << n;
        }
      }
    }
  }
}

TEST(PolygonOracle, SegmentsThroughEdgesAndCornersOfACubeCrossItOnceForEachSide) {
  const auto oracle = make_polygon_oracle(cube(2, 0.5));
  const Point3 middle{0.5, 0.5, 0.5};
  for (int i = 0; i < 27; ++i) {
    const Vector3 direction{double(i % 3 - 1), double(i / 3 % 3 - 1), double(i / 9 - 1)};
    if (norm(direction) == 0) continue;
    // Through a corner, the middle of an edge, or of a face, where edges of triangles meet.
    const Point3 out = middle + 2.0 * direction, through = middle + 0.5 * direction;
    ASSERT_EQ(oracle->intersect_all(middle, out).size(), 1u);
    EXPECT_LT(distance(oracle->intersect(middle, out), through), 1e-15);
    EXPECT_EQ(oracle->intersect_all(middle - 2.0 * direction, out).size(), 2u);
  }
}

TEST(PolygonOracle, SegmentsInAFaceOrAlongAnEdgeHaveAnEvenNumberOfCrossings) {
  const auto oracle = make_polygon_oracle(cube());
  test::Random random(5);
  for (int n = 0; n < 200; ++n) {
    const double y = n % 2 == 0 ? 0 : random.unit();
    EXPECT_EQ(oracle->intersect_all({-1, y, 0}, {2, y, 0}).size() % 2, 0u);
    EXPECT_EQ(oracle->intersect_all({-1, y - random.unit(), 1}, {2, y + random.unit(), 1}).size() % 2, 0u);
  }
}

TEST(PolygonOracle, CrossingsLieOnTheFacesExactlyHoweverObliqueTheSegment) {
  const auto oracle = make_polygon_oracle(cube());
  test::Random random(6);
  for (int n = 0; n < 2000; ++n) {
    const double slope = std::pow(10, -12 * random.unit());
    const Point3 a{0.3, 0.4, 1 - 0.3 * slope}, b{0.3 + random.unit(), 0.4, 1 + slope};
    for (const Point3& p : oracle->intersect_all(a, b)) {
      double nearest = 1;
      for (int axis = 0; axis < 3; ++axis) nearest = std::min({nearest, std::abs(p[axis]), std::abs(1 - p[axis])});
      EXPECT_LT(nearest, 1e-15);
    }
  }
}

TEST(PolygonOracle, NestedShellsAlternateWhicheverWayTheyFace) {
  SurfaceMesh mesh = test::icosphere(3, 4);
  test::append(mesh, test::icosphere(3, 3));
  test::append(mesh, test::inverted(test::icosphere(3, 2)));
  test::append(mesh, test::inverted(test::icosphere(2, 1)));
  const auto oracle = make_polygon_oracle(mesh);
  test::Random random(7);
  for (int n = 0; n < 5000; ++n) {
    const Vector3 direction = random.direction();
    const double radius = 4.5 * random.unit();
    if (std::abs(radius - std::round(radius)) < 0.1) continue;  // the spheres are polyhedra
    const int shells = 4 - static_cast<int>(std::floor(radius));
    EXPECT_EQ(oracle->label(radius * direction), std::max(0, shells) % 2) << radius;
  }
  EXPECT_EQ(oracle->topology(), (SurfaceTopology{4, 8}));
}

TEST(PolygonOracle, LabelsAgreeWithTheParityOfTheCrossingsOnTheWayOut) {
  const auto oracle = make_polygon_oracle(test::icosphere(2, 1, {10, 20, 30}));
  test::Random random(8);
  const Box3 bounds = oracle->bounds();
  for (int n = 0; n < 3000; ++n) {
    const Point3 p = random.in(bounds), out = p + 10.0 * random.direction();
    ASSERT_EQ(oracle->label(out), 0);
    EXPECT_EQ(oracle->intersect_all(p, out).size() % 2, static_cast<std::size_t>(oracle->label(p)));
  }
}

TEST(PolygonOracle, SeedsAreInputVerticesWhereThoseAreDenseEnough) {
  const SurfaceMesh sphere = test::icosphere(4);
  const Seeds seeds = make_polygon_oracle(sphere)->seeds(0.3);
  EXPECT_GT(seeds.points.size(), 50u);
  for (const Point3& p : seeds.points) {
    EXPECT_TRUE(std::find(sphere.points.begin(), sphere.points.end(), p) != sphere.points.end());
  }
}

TEST(PolygonOracle, SeedsFillLongTrianglesAndNeedlesToo) {
  // A bar a hundred times as long as wide, of twelve triangles.
  SurfaceMesh bar = cube();
  for (Point3& p : bar.points) p.x *= 100;
  const Seeds seeds = make_polygon_oracle(bar)->seeds(0.5);
  for (double x = 0; x <= 100; x += 0.5) {
    double nearest = 1e9;
    for (const Point3& p : seeds.points) nearest = std::min(nearest, distance(p, {x, 0, 0}));
    EXPECT_LT(nearest, 1.0) << x;
  }
}

TEST(PolygonOracle, PatchesHoldTheAreaAndTheVolume) {
  SurfaceMesh mesh = test::icosphere(4, 2);
  test::append(mesh, test::icosphere(4, 1));  // a cavity
  double volume = 0;
  Vector3 up, down;
  make_polygon_oracle(mesh)->for_each_patch([&](const DomainPatch& patch) {
    volume += patch.inside_mm3;
    up = up + patch.area_up;
    down = down + patch.area_down;
    // Outside lies away from the middle without, towards it within.
    for (int axis = 0; axis < 3; ++axis) {
      const double radius = norm(patch.center), toward = patch.center[axis];
      if (std::abs(toward) < 0.3 || std::abs(radius - 1.5) < 0.25) continue;
      const double expected = (radius > 1.5) == (toward > 0) ? patch.area_down[axis] : patch.area_up[axis];
      EXPECT_EQ(expected, 0) << radius << ' ' << toward;
    }
  });
  const double pi = 3.14159265358979;
  EXPECT_NEAR(volume, 4.0 / 3 * pi * 7, 0.4);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(up[axis], pi * 5, 0.1);  // the shadows of both spheres
    EXPECT_NEAR(down[axis], pi * 5, 0.1);
  }
}

}  // namespace
}  // namespace delvox
