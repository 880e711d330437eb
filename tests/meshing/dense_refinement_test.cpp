// Refinement without Del S once the sample is dense (exercise 3 of the book's chapter 14; Dey and Levine 2008).
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/errors.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/oracle/formula.h"
#include "delvox/oracle/polygon_oracle.h"
#include "mesh_expectations.h"
#include "meshing/extract.h"
#include "meshing/surface_triangulation.h"
#include "phantom_cases.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

using test::PhantomCase;

DelSurfOptions dense_options(double size, double min_ball_radius = 1e-4) {
  DelSurfOptions options;
  options.surface.size = size;
  options.surface.min_ball_radius = min_ball_radius;
  options.surface_only_after_dense = true;
  return options;
}

std::unique_ptr<SmoothOracle> formula(const std::string& text) {
  return make_formula_oracle(Formula(text), {{-2, -2, -2}, {2, 2, 2}}, 0.05);
}
std::unique_ptr<SmoothOracle> unit_sphere() { return formula("x^2+y^2+z^2-1"); }

/// Triangles by their corners' coordinates, whatever these are numbered.
using Corners = std::array<std::array<double, 3>, 3>;
std::set<Corners> triangles_of(const SurfaceMesh& mesh) {
  std::set<Corners> all;
  for (const Triangle& t : mesh.triangles) {
    Corners corners;
    for (int i = 0; i < 3; ++i) corners[i] = {mesh.points[t[i]].x, mesh.points[t[i]].y, mesh.points[t[i]].z};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.insert(corners);
  }
  return all;
}

/// Del|Sigma of the points, by way of Del S.
SurfaceMesh restricted_delaunay(const Oracle& oracle, const std::vector<Point3>& points) {
  RestrictedDelaunay delaunay(oracle);
  delaunay.insert_seeds(points);
  return extract_surface(delaunay);
}

struct AnalyticCase {
  const char* name;
  const char* formula;
  double size, volume;
  long euler;
};
void PrintTo(const AnalyticCase& c, std::ostream* out) { *out << c.name; }

constexpr double kPi = std::numbers::pi;

class DenseRefinementOfFormulas : public testing::TestWithParam<AnalyticCase> {};

INSTANTIATE_TEST_SUITE_P(
    Surfaces, DenseRefinementOfFormulas,
    testing::Values(AnalyticCase{"Sphere", "x^2+y^2+z^2-1", 0.1, 4 * kPi / 3, 2},
                    AnalyticCase{"Ellipsoid", "x^2+(y/0.6)^2+(z/1.5)^2-1", 0.06, 4 * kPi / 3 * 0.6 * 1.5, 2},
                    AnalyticCase{"Torus", "(sqrt(x^2+y^2)-1.2)^2+z^2-0.16", 0.06, 2 * kPi * kPi * 1.2 * 0.16, 0},
                    AnalyticCase{"TwoSpheres", "min((x-1)^2+y^2+z^2-0.49, (x+0.8)^2+y^2+z^2-1)", 0.08,
                                 4 * kPi / 3 * (0.343 + 1), 4}),
    [](const auto& info) { return info.param.name; });

TEST_P(DenseRefinementOfFormulas, GivesDelSigmaWithAllThatDelSurfPromisesTwiceAlike) {
  const AnalyticCase& c = GetParam();
  const auto oracle = formula(c.formula);
  RunReport report, again;
  const SurfaceMesh mesh = delsurf(*oracle, dense_options(c.size), report);
  test::expect_finished(report);
  EXPECT_TRUE(mesh.info.complete);
  EXPECT_EQ(mesh.info.promises.size, c.size);
  EXPECT_EQ(mesh.info.promises.min_angle_degrees, 30);
  EXPECT_EQ(report.dense_failures, 0u);
  EXPECT_GT(report.dense_insertions, 10 * report.surface_insertions);
  test::expect_closed_manifold(mesh);
  test::expect_good_triangles(mesh, c.size);
  test::expect_all_checks_hold(mesh);
  for (const Point3& p : mesh.points) test::expect_on_surface(*oracle, p, 1);
  EXPECT_EQ(test::topology_of(mesh).euler, c.euler);
  EXPECT_NEAR(test::enclosed_volume(mesh) / c.volume, 1, 0.02);
  EXPECT_EQ(triangles_of(mesh), triangles_of(restricted_delaunay(*oracle, mesh.points)));

  const SurfaceMesh second = delsurf(*oracle, dense_options(c.size), again);
  EXPECT_EQ(second.points, mesh.points);
  EXPECT_EQ(second.triangles, mesh.triangles);
}

class DenseRefinementOfPhantoms : public testing::TestWithParam<PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(
    Phantoms, DenseRefinementOfPhantoms,
    testing::Values(PhantomCase{"sphere", test::cubic_image(32), 2}, PhantomCase{"torus", test::cubic_image(32), 1.2},
                    PhantomCase{"shells", test::cubic_image(32), 1.5},
                    PhantomCase{"touching-balls", test::cubic_image(32), 1.2},
                    PhantomCase{"plate", test::cubic_image(28), 0.8}, PhantomCase{"rod", test::cubic_image(28), 0.8},
                    PhantomCase{"oblique-sphere", test::oblique_image(), 1.5},
                    PhantomCase{"border", test::cubic_image(28), 1.5},
                    PhantomCase{"gyroid", test::cubic_image(24), 0.5},
                    PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(14), 0.7), 0.5},
                    PhantomCase{"random", test::cubic_image(7), 0.5, 1.3}),
    [](const auto& info) { return test::test_name(info.param); });

TEST_P(DenseRefinementOfPhantoms, KeepsWhatDelSurfKeepsForAnyNumberOfThreads) {
  const PhantomCase& c = GetParam();
  const Volume volume = c.volume();
  const auto oracle = make_isosurface_oracle(volume, c.isosurface());
  const DelSurfOptions options = dense_options(c.size, c.min_ball_radius());
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_finished(report);
  EXPECT_TRUE(mesh.info.complete);
  test::expect_closed_manifold(mesh);
  test::expect_good_triangles(mesh, c.size);
  test::expect_all_checks_hold(mesh);
  for (const Point3& p : mesh.points) test::expect_on_surface(*oracle, p, c.voxel());
  const VoxelTopology voxels = count_topology(volume, c.isosurface());
  EXPECT_EQ(test::topology_of(mesh).components, voxels.surface_components);
  EXPECT_EQ(test::topology_of(mesh).euler, voxels.euler);
  EXPECT_NEAR(test::enclosed_volume(mesh), voxels.volume_mm3, 0.5 * c.size * c.size * test::area_of(mesh) / 4);
  for (std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    RunReport again;
    const SurfaceMesh second = delsurf(*oracle, options, again);
    EXPECT_EQ(second.points, mesh.points);
    EXPECT_EQ(second.triangles, mesh.triangles);
    EXPECT_EQ(again.dense_insertions, report.dense_insertions);
    EXPECT_EQ(again.dense_failures, report.dense_failures);
  }
}

TEST(DenseRefinement, MakesDelSAgainWhereAFewPlacesAreTooRough) {
  const PhantomCase c{"gyroid", test::cubic_image(28), 0.5};
  const auto oracle = make_isosurface_oracle(c.volume(), c.isosurface());
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, dense_options(c.size, c.min_ball_radius()), report);
  EXPECT_GT(report.dense_insertions, 0u);
  EXPECT_GT(report.dense_failures, 0u);
  test::expect_finished(report);
  test::expect_closed_manifold(mesh);
  test::expect_good_triangles(mesh, c.size);
  test::expect_all_checks_hold(mesh);
}

TEST(DenseRefinement, IsDelSurfWhereTheSampleDoesNotGetDense) {
  const PhantomCase c{"noisy-sphere", test::with_noise(test::cubic_image(20), 0.7), 0.7};
  const auto oracle = make_isosurface_oracle(c.volume(), c.isosurface());
  RunReport report, plain_report;
  DelSurfOptions options = dense_options(c.size, c.min_ball_radius());
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  options.surface_only_after_dense = false;
  const SurfaceMesh plain = delsurf(*oracle, options, plain_report);
  EXPECT_EQ(report.dense_insertions, 0u);
  EXPECT_EQ(report.surface_insertions, plain_report.surface_insertions);
  EXPECT_EQ(mesh.points, plain.points);
  EXPECT_EQ(mesh.triangles, plain.triangles);
}

TEST(DenseRefinement, KeepsToADeviationBoundAndASizeField) {
  const auto oracle = unit_sphere();
  DelSurfOptions options = dense_options(1);
  options.surface.size = SizeField([](const Point3& p) { return 0.1 + 0.05 * (p.z + 1); }, 0.1, 0.2);
  options.surface.max_deviation = 0.004;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_finished(report);
  EXPECT_EQ(report.dense_failures, 0u);
  EXPECT_GT(report.dense_insertions, 0u);
  test::expect_closed_manifold(mesh);
  test::expect_all_checks_hold(mesh);
  EXPECT_EQ(mesh.info.promises.max_deviation, 0.004);
  for (const Triangle& t : mesh.triangles) {
    const Point3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    const Point3 center = test::circumcenter(a, b, c);
    EXPECT_LE(1 - norm(center), 0.004 * (1 + 1e-9));
    EXPECT_LE(distance(center, a), 0.1 + 0.05 * (center.z / norm(center) + 1) + 1e-9);
  }
}

TEST(DenseRefinement, TakesPolygonSurfaces) {
  RunReport plain;
  const auto sphere = unit_sphere();
  DelSurfOptions options = dense_options(0.3);
  const auto polygons = make_polygon_oracle(delsurf(*sphere, options, plain));
  options = dense_options(0.1);
  RunReport report;
  const SurfaceMesh mesh = delsurf(*polygons, options, report);
  test::expect_finished(report);
  EXPECT_GT(report.dense_insertions, 0u);
  test::expect_closed_manifold(mesh);
  test::expect_good_triangles(mesh, 0.1);
  EXPECT_EQ(test::topology_of(mesh).euler, 2);
}

TEST(DenseRefinement, StopsAtALimitWithAClosedMeshThatIsMarked) {
  const auto oracle = unit_sphere();
  RunReport whole, report;
  const std::size_t vertices = delsurf(*oracle, dense_options(0.05), whole).points.size();
  DelSurfOptions options = dense_options(0.05);
  options.control.limits.max_vertices = vertices - whole.dense_insertions / 2;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  EXPECT_EQ(report.stop, StopReason::kMaxVertices);
  EXPECT_FALSE(mesh.info.complete);
  EXPECT_EQ(mesh.points.size(), options.control.limits.max_vertices);
  test::expect_closed_manifold(mesh);
}

TEST(DenseRefinement, RefusesWhatNeedsDelSToTheEnd) {
  const auto oracle = unit_sphere();
  RunReport report;
  DelSurfOptions options = dense_options(0.2);
  options.variant.start = Start::kPersistent;
  EXPECT_THROW(delsurf(*oracle, options, report), OptionError);
  options = dense_options(0.2);
  options.variant.restricted = Restricted::kAll;
  EXPECT_THROW(delsurf(*oracle, options, report), OptionError);
  options = dense_options(0.2);
  options.surface.max_roughness_degrees = 30;
  EXPECT_THROW(delsurf(*oracle, options, report), OptionError);
}

// The triangulation itself.

std::optional<SurfaceTriangulation> triangulation_of(std::vector<Point3> points, const std::vector<Triangle>& triangles) {
  return SurfaceTriangulation::make(std::move(points), triangles, std::vector<SurfaceBall>(triangles.size()));
}

const std::vector<Point3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Triangle> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

TEST(SurfaceTriangulation, IsMadeOfClosedOrientedManifoldsOnly) {
  EXPECT_TRUE(triangulation_of(kCorners, kTetrahedron));
  auto triangles = kTetrahedron;
  triangles.pop_back();
  EXPECT_FALSE(triangulation_of(kCorners, triangles)) << "open";
  triangles = kTetrahedron;
  std::swap(triangles[0][0], triangles[0][1]);
  EXPECT_FALSE(triangulation_of(kCorners, triangles)) << "turned round";
  triangles = kTetrahedron;
  triangles.insert(triangles.end(), kTetrahedron.begin(), kTetrahedron.end());
  EXPECT_FALSE(triangulation_of(kCorners, triangles)) << "each edge four times";
  triangles = kTetrahedron;
  auto points = kCorners;
  for (int i = 1; i < 4; ++i) points.push_back(-1 * kCorners[i]);
  for (Triangle t : kTetrahedron) {
    for (std::uint32_t& v : t) v = v == 0 ? 0 : v + 3;
    std::swap(t[0], t[1]);
    triangles.push_back(t);
  }
  EXPECT_FALSE(triangulation_of(points, triangles)) << "two that meet in a vertex";
}

/// A sphere's, with its balls.
SurfaceTriangulation sphere_triangulation(const Oracle& oracle, std::vector<Point3> more_points = {}) {
  RunReport report;
  SurfaceMesh mesh = delsurf(oracle, dense_options(0.3), report);
  std::vector<SurfaceBall> balls;
  for (const Triangle& t : mesh.triangles) {
    const Point3 middle = test::circumcenter(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    const Point3 center = (1 / norm(middle)) * middle;
    balls.push_back({center, squared_distance(center, mesh.points[t[0]])});
  }
  mesh.points.insert(mesh.points.end(), more_points.begin(), more_points.end());
  return *SurfaceTriangulation::make(mesh.points, mesh.triangles, balls);
}

TEST(SurfaceTriangulation, InsertionsKeepItDelaunay) {
  const auto oracle = unit_sphere();
  SurfaceTriangulation surface = sphere_triangulation(*oracle);
  for (std::uint32_t t = 0; t < 80; t += 7) {
    const std::size_t before = surface.size();
    const Point3 p = surface.ball(t).center;
    ASSERT_LT(t, before);
    ASSERT_TRUE(surface.insert_ball_center(t, *oracle));
    EXPECT_EQ(surface.size(), before + 2);
    EXPECT_EQ(surface.points().back(), p);
    EXPECT_GE(surface.created().size(), 3u);
    for (std::uint32_t made : surface.created()) {
      EXPECT_EQ(surface.corners(made)[2], surface.points().size() - 1);
      EXPECT_NEAR(norm(surface.ball(made).center), 1, 1e-9);
      EXPECT_NEAR(surface.ball(made).squared_radius, squared_distance(surface.ball(made).center, p), 1e-12);
    }
  }
  EXPECT_TRUE(surface.look_into_balls({}).occupied.empty());
  SurfaceMesh mesh;
  mesh.points = surface.points();
  for (std::uint32_t t = 0; t < surface.size(); ++t) mesh.triangles.push_back(surface.corners(t));
  test::expect_closed_manifold(mesh);
  EXPECT_EQ(triangles_of(mesh), triangles_of(restricted_delaunay(*oracle, mesh.points)));
}

TEST(SurfaceTriangulation, FindsTheBallsWithAVertexOfAnotherPartOfTheSurface) {
  const auto oracle = unit_sphere();
  const Point3 stranger{0.6, 0.1, 0.75};
  const SurfaceTriangulation surface = sphere_triangulation(*oracle, {stranger});
  std::vector<std::uint32_t> expected;
  for (std::uint32_t t = 0; t < surface.size(); ++t) {
    if (squared_distance(surface.ball(t).center, stranger) < surface.ball(t).squared_radius) expected.push_back(t);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(surface.look_into_balls({}).occupied, expected);
}

TEST(SurfaceTriangulation, CoversItsSurfaceWithItsBallsAndNothingElse) {
  const auto oracle = unit_sphere();
  std::vector<Point3> probes = oracle->seeds(0.05).points;
  const SurfaceTriangulation surface = sphere_triangulation(*oracle);
  EXPECT_TRUE(surface.look_into_balls(probes).uncovered.empty());
  probes.push_back({1.6, 0, 0});
  const std::vector<std::uint32_t> expected{static_cast<std::uint32_t>(probes.size() - 1)};
  EXPECT_EQ(surface.look_into_balls(probes).uncovered, expected);
}

}  // namespace
}  // namespace delvox
