#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "support/shapes.h"

// Bounds that vary or that need the surface to be judged, on a sphere around the origin given by a formula: there the
// dual line of a triangle goes through the centre, so surface balls are known without the mesher.

namespace delvox {
namespace {

constexpr double kRadius = 10;

std::unique_ptr<SmoothOracle> sphere() {
  return test::implicit_phantom_oracle("sphere", test::cubic_image(32), 0.5);  // radius 0.625 * 16
}

/// The centre of the surface Delaunay ball of a triangle with corners on the sphere.
Point3 ball_center(const SurfaceMesh& mesh, const Triangle& t) {
  const Point3 c = test::circumcenter(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
  return (kRadius / norm(c)) * c;
}

SurfaceMesh mesh_sphere(const SurfaceCriteria& criteria) {
  RunReport report;
  return test::closed_surface(*sphere(), criteria, 2, report);
}

TEST(Criteria, SurfaceBallsKeepASizeThatIsANumber) {
  SurfaceCriteria criteria;
  criteria.size = 2.5;
  const SurfaceMesh mesh = mesh_sphere(criteria);
  double largest = 0;
  for (const Triangle& t : mesh.triangles) {
    largest = std::max(largest, distance(ball_center(mesh, t), mesh.points[t[0]]));
  }
  EXPECT_LE(largest, 2.5 * (1 + 1e-9));
  EXPECT_GT(largest, 1.5);
}

TEST(Criteria, SurfaceBallsKeepASizeFieldAtTheirCentres) {
  const auto field = [](const Point3& p) { return 0.6 + 2.4 * (p.z + kRadius) / (2 * kRadius); };
  SurfaceCriteria criteria;
  criteria.size = SizeField(field, 0.6, 3.0);
  const SurfaceMesh mesh = mesh_sphere(criteria);
  std::size_t north = 0, south = 0, loose = 0;
  for (const Triangle& t : mesh.triangles) {
    const Point3 center = ball_center(mesh, t);
    const double radius = distance(center, mesh.points[t[0]]);
    EXPECT_LE(radius, field(center) * (1 + 1e-9));
    loose += radius > 1.2;
    (center.z > 5 ? north : center.z < -5 ? south : loose) += center.z > 5 || center.z < -5;
  }
  // The southern cap is asked for triangles of 0.6 to 1.2, the northern for 2.4 to 3: at least four times as many.
  EXPECT_GT(south, 4 * north);
  EXPECT_GT(loose, 0u);  // and the north was not refined to the south's size
}

TEST(Criteria, DeviationIsBoundedWhereAskedAndOnlyThere) {
  const auto largest_deviation = [](const SurfaceMesh& mesh) {
    double largest = 0;
    for (const Triangle& t : mesh.triangles) {
      const Point3 c = test::circumcenter(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
      largest = std::max(largest, kRadius - norm(c));
    }
    return largest;
  };
  SurfaceCriteria criteria;
  criteria.size = 4;
  const SurfaceMesh coarse = mesh_sphere(criteria);
  EXPECT_GT(largest_deviation(coarse), 0.3);
  criteria.max_deviation = 0.05;
  const SurfaceMesh fine = mesh_sphere(criteria);
  EXPECT_LE(largest_deviation(fine), 0.05 * (1 + 1e-6));
  EXPECT_GT(fine.triangles.size(), 2 * coarse.triangles.size());
  EXPECT_EQ(fine.info.promises.max_deviation, 0.05);
}

TEST(Criteria, DeviationThatCannotBeMetAtTheSmallestBallIsCountedAndBreaksNoPromise) {
  SurfaceCriteria criteria;
  criteria.size = 4;
  criteria.max_deviation = 1e-4;
  criteria.min_ball_radius = 2;
  DelSurfOptions options;
  options.surface = criteria;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*sphere(), options, report);
  ASSERT_EQ(report.unmet.size(), 1u);
  EXPECT_EQ(report.unmet[0].criterion, "deviation");
  EXPECT_GT(report.unmet[0].count, 10u);
  EXPECT_FALSE(report.unmet[0].breaks_promise);
  EXPECT_TRUE(report.succeeded());
  test::expect_closed_manifold(mesh);
}

TEST(Criteria, AnglesReachTheBoundThatIsAskedFor) {
  double before = 0;
  for (double angle : {0.0, 20.0, 30.0}) {
    SurfaceCriteria criteria;
    criteria.size = 2;
    criteria.min_angle_degrees = angle;
    const SurfaceMesh mesh = mesh_sphere(criteria);
    double smallest = 60;
    for (const Triangle& t : mesh.triangles) {
      smallest =
          std::min(smallest, test::smallest_angle_degrees(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
    }
    EXPECT_GE(smallest, angle - 1e-9);
    EXPECT_GE(mesh.triangles.size(), before);
    before = static_cast<double>(mesh.triangles.size());
  }
}

TEST(Criteria, TetsKeepACellSizeFieldAtTheirCircumcentres) {
  const auto field = [](const Point3& p) { return p.x < 0 ? 1.2 : 3.0; };
  DelTetSurfOptions options;
  options.surface.size = 2;
  options.tets.cell_size = SizeField(field, 1.2, 3.0);
  RunReport report;
  const TetMesh mesh = deltetsurf(*sphere(), options, report);
  test::expect_finished(report);
  test::expect_closed_manifold(boundary_surface(mesh));
  std::size_t fine = 0, coarse = 0, larger = 0;
  for (const Tet& tet : mesh.tets) {
    const test::TetShape shape = test::shape_of(mesh, tet);
    // A circumcentre on the very step of the field may fall to either side of it.
    if (std::abs(shape.circumcenter.x) < 1e-6) continue;
    EXPECT_LE(shape.circumradius, field(shape.circumcenter) * (1 + 1e-7));
    (shape.circumcenter.x < 0 ? fine : coarse) += 1;
    larger += shape.circumradius > 1.2;
  }
  EXPECT_GT(fine, 2 * coarse);
  EXPECT_GT(larger, 0u);
}

TEST(Criteria, TetsKeepALooserRadiusEdgeRatioToo) {
  for (double bound : {2.0, 4.0}) {
    DelTetSurfOptions options;
    options.surface.size = 3;
    options.tets.cell_size = 10;
    options.tets.radius_edge = bound;
    RunReport report;
    const TetMesh mesh = deltetsurf(*sphere(), options, report);
    test::expect_finished(report);
    double worst = 0;
    for (const Tet& tet : mesh.tets) {
      const test::TetShape shape = test::shape_of(mesh, tet);
      worst = std::max(worst, shape.circumradius / shape.shortest_edge);
    }
    EXPECT_LE(worst, bound * (1 + 1e-7));
  }
}

}  // namespace
}  // namespace delvox
