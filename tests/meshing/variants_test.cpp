// The book's variants of DelSurf and DelTetSurf: persistent triangles (14.1, 14.1.2) and Del|Sigma in full (14.1.3,
// step 4 of DelTetSurf).
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "delaunay/restricted_delaunay.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/oracle/formula.h"
#include "delvox/oracle/polygon_oracle.h"
#include "mesh_expectations.h"
#include "meshing/extract.h"
#include "meshing/persistent_triangle.h"
#include "meshing/refinement.h"
#include "support/shapes.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

constexpr Restricted kBoth[] = {Restricted::kBipolar, Restricted::kAll};

std::unique_ptr<SmoothOracle> formula(const std::string& text) {
  return make_formula_oracle(Formula(text), {{-2, -2, -2}, {2, 2, 2}}, 0.05);
}
std::unique_ptr<SmoothOracle> unit_sphere() {
  return formula("x^2+y^2+z^2-1");
}
std::unique_ptr<SmoothOracle> torus() {
  return formula("(sqrt(x^2+y^2)-1.2)^2+z^2-0.16");
}

double shortest_edge(const SurfaceMesh& mesh) {
  double shortest = Box3::kInfinity;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) shortest = std::min(shortest, distance(mesh.points[t[i]], mesh.points[t[(i + 1) % 3]]));
  }
  return shortest;
}

DelSurfOptions options_for(double size, Variant variant, double min_angle = 30) {
  DelSurfOptions options;
  options.surface.size = size;
  options.surface.min_angle_degrees = min_angle;
  options.surface.min_ball_radius = 1e-4;
  options.variant = variant;
  return options;
}

SurfaceMesh mesh_of(const Oracle& oracle, const DelSurfOptions& options, RunReport& report) {
  const SurfaceMesh mesh = delsurf(oracle, options, report);
  test::expect_finished(report);
  test::expect_closed_manifold(mesh);
  test::expect_all_checks_hold(mesh);
  return mesh;
}

TEST(PersistentTriangle, LiesNearItsPointAndItsDualLineMeetsTheSurfaceThere) {
  for (const auto& oracle : {unit_sphere(), torus()}) {
    const Point3 x = oracle->seeds(0.3).points[5];
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      RandomStream random(seed);
      const auto triangle = find_persistent_triangle(*oracle, x, 0.21, random);
      ASSERT_TRUE(triangle);
      const auto& t = *triangle;
      for (const Point3& p : t) {
        EXPECT_LE(distance(p, x), 0.21 / 7);
        EXPECT_NEAR(oracle->value(p), 0, 1e-12);
      }
      const Point3 c = test::circumcenter(t[0], t[1], t[2]);
      const Vector3 n = cross(t[1] - t[0], t[2] - t[0]);
      std::size_t in_ball = 0;
      for (const Point3& p : oracle->intersect_all(c - (1 / norm(n)) * n, c + (1 / norm(n)) * n)) {
        in_ball += distance(p, x) <= 0.21 / 7;
      }
      EXPECT_GT(in_ball, 0u);
      RandomStream same(seed), other(seed + 1000);
      EXPECT_EQ(find_persistent_triangle(*oracle, x, 0.21, same), triangle);
      EXPECT_NE(find_persistent_triangle(*oracle, x, 0.21, other), triangle);
    }
  }
}

TEST(PersistentTriangle, IsFoundOnSurfacesMuchSmallerThanTheSizeAndAtCornersOfCubes) {
  const auto cube = make_polygon_oracle(boundary_surface(test::cube_mesh(1, 1)));
  for (double size : {0.1, 1.0, 1000.0}) {
    RandomStream random(3);
    EXPECT_TRUE(find_persistent_triangle(*cube, {1, 1, 1}, size, random)) << size;
    EXPECT_TRUE(find_persistent_triangle(*cube, {0.5, 0, 0}, size, random)) << size;
  }
}

// At a constant size no two vertices may be nearer than that, but those of the persistent triangle: of these one is
// left.
TEST(PersistentStart, LeavesNoTraceOfTheSmallTriangle) {
  for (Restricted restricted : kBoth) {
    for (double min_angle : {0.0, 30.0}) {
      RunReport report;
      const auto options = options_for(0.15, {Start::kPersistent, restricted, 7}, min_angle);
      const SurfaceMesh mesh = mesh_of(*unit_sphere(), options, report);
      EXPECT_EQ(test::topology_of(mesh).euler, 2);
      EXPECT_GE(shortest_edge(mesh), 0.15);
      EXPECT_EQ(report.removals, 2u);
      EXPECT_EQ(report.reinsertions, 0u);
    }
  }
}

TEST(PersistentStart, EveryComponentGetsOne) {
  // Two shells and a ball beside them.
  const auto nested =
      formula("min(max(x^2+y^2+z^2-1, 0.36-x^2-y^2-z^2), min(x^2+y^2+z^2-0.09, (x-1.5)^2+(y-1)^2+(z-1)^2-0.04))");
  for (Restricted restricted : kBoth) {
    RunReport report;
    const SurfaceMesh mesh = mesh_of(*nested, options_for(0.1, {Start::kPersistent, restricted, 0}), report);
    EXPECT_EQ(test::topology_of(mesh).components, 4u);
    EXPECT_EQ(test::topology_of(mesh).euler, 8);
    EXPECT_EQ(report.removals, 8u);
  }
}

TEST(PersistentStart, ComponentsSmallerThanTheSizeAreNotLost) {
  const auto balls = formula("min(x^2+y^2+z^2-1, min((x-1.4)^2+y^2+z^2-0.01, (x+1.4)^2+y^2+z^2-0.01))");
  for (Restricted restricted : kBoth) {
    RunReport report;
    const SurfaceMesh mesh = mesh_of(*balls, options_for(0.3, {Start::kPersistent, restricted, 5}), report);
    EXPECT_EQ(test::topology_of(mesh).components, 3u);
    EXPECT_EQ(test::topology_of(mesh).euler, 6);
  }
}

// Theorem 14.9 (i): a manifold whatever the size. Triangles do not persist at sizes as large as the surface.
TEST(PersistentStart, AnySizeGivesAManifold) {
  const auto oracle = torus();
  for (Restricted restricted : kBoth) {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      for (double size : {0.5, 2.0, 50.0}) {
        RunReport report;
        mesh_of(*oracle, options_for(size, {Start::kPersistent, restricted, seed}), report);
      }
    }
  }
}

/// Another oracle, which sees nothing of its surface for a while.
class BlindableOracle final : public Oracle {
 public:
  BlindableOracle(const Oracle& other, const bool& blind) : other_(other.clone()), blind_(blind) {}
  Box3 bounds() const override { return other_->bounds(); }
  Label label(const Point3& p) const override { return blind_ ? 0 : other_->label(p); }
  Point3 intersect(const Point3& a, const Point3& b) const override { return other_->intersect(a, b); }
  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    return blind_ ? std::vector<Point3>{} : other_->intersect_all(a, b);
  }
  Seeds seeds(const SizeField& size, const GoOn& go_on) const override { return other_->seeds(size, go_on); }
  std::unique_ptr<Oracle> clone() const override { return std::make_unique<BlindableOracle>(*other_, blind_); }

 private:
  std::unique_ptr<Oracle> other_;
  const bool& blind_;
};

// No surface is known on which refinement is stuck without the deleted vertices; so it is made to be.
TEST(PersistentStart, DeletedVerticesComeBackWhereRefinementIsStuckAndGoInTheEnd) {
  bool blind = false;
  const BlindableOracle oracle(*torus(), blind);
  const DelSurfOptions options = options_for(50, {Start::kPersistent, Restricted::kBipolar, 3});
  RunReport report;
  Refinement refinement(oracle, options.surface, options.control, options.variant, report);
  const auto converge = [&] {
    do refinement.refine();
    while (refinement.repair());
  };
  refinement.start();
  converge();
  const std::size_t vertices = refinement.delaunay().vertex_count();
  blind = true;
  ASSERT_TRUE(refinement.delete_persistent_vertex());
  refinement.refine();
  EXPECT_EQ(refinement.delaunay().vertex_count(), vertices - 1);
  EXPECT_TRUE(refinement.mend_inadequate());
  EXPECT_EQ(refinement.delaunay().vertex_count(), vertices);
  EXPECT_EQ(report.reinsertions, 1u);
  blind = false;
  do converge();
  while (refinement.delete_persistent_vertex());
  refinement.report_unmet();
  EXPECT_TRUE(report.unmet.empty());
  EXPECT_EQ(report.reinsertions, 1u);
  EXPECT_EQ(report.removals, 3u);
  test::expect_closed_manifold(extract_surface(refinement.delaunay()));
}

TEST(PersistentStart, DependsOnTheSeedAndOnNothingElse) {
  const auto oracle = torus();
  DelTetSurfOptions options;
  options.surface.size = options.tets.cell_size = 0.2;
  options.surface.min_ball_radius = 1e-4;
  for (Restricted restricted : kBoth) {
    options.variant = {Start::kPersistent, restricted, 1};
    TetMesh first;
    for (std::size_t threads : {1, 2, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      RunReport report;
      const TetMesh mesh = deltetsurf(*oracle, options, report);
      test::expect_finished(report);
      if (threads == 1) {
        first = mesh;
        test::expect_all_checks_hold(mesh);
      }
      EXPECT_EQ(mesh.points, first.points);
      EXPECT_EQ(mesh.tets, first.tets);
    }
    options.variant.seed = 2;
    RunReport report;
    EXPECT_NE(deltetsurf(*oracle, options, report).points, first.points);
  }
}

/// Facets of the Delaunay triangulation of some points whose dual edges meet the surface, but with both ends on one
/// side of it.
std::size_t two_faced_facets(const Oracle& oracle, const std::vector<Point3>& points) {
  RestrictedDelaunay delaunay(oracle);
  delaunay.insert_seeds(points);
  std::size_t count = 0;
  for (CellId cell = 1; cell < delaunay.cell_capacity(); ++cell) {
    for (int i = 0; i < 4 && delaunay.stamp(cell) != 0; ++i) {
      if (delaunay.neighbors(cell)[i] < cell || !delaunay.proper({cell, i}) || delaunay.bipolar({cell, i})) continue;
      count += !delaunay.dual_crossings({cell, i}, oracle).empty();
    }
  }
  return count;
}

// A lens thinner than the size, of which bipolar edges see next to nothing.
TEST(RestrictedToAll, NoDualEdgeMeetsTheSurfaceTwiceInTheEnd) {
  const auto lens = formula("x^2+y^2+(z/0.08)^2-1");
  RunReport report;
  const SurfaceMesh bipolar = delsurf(*lens, options_for(0.4, {Start::kSeeds, Restricted::kBipolar, 0}), report);
  EXPECT_LT(test::area_of(bipolar), 1);
  for (Start start : {Start::kSeeds, Start::kPersistent}) {
    const SurfaceMesh all = mesh_of(*lens, options_for(0.4, {start, Restricted::kAll, 0}), report);
    EXPECT_EQ(two_faced_facets(*lens, all.points), 0u);
    EXPECT_GT(test::area_of(all), 5.5);  // of 6.4
    EXPECT_EQ(test::topology_of(all).components, 1u);
    EXPECT_EQ(test::topology_of(all).euler, 2);
  }
}

TEST(RestrictedToAll, WorksOnVoxelsAndPolygonsToo) {
  const auto voxels = test::voxel_phantom_oracle("torus", test::cubic_image(24));
  const auto polygons = make_polygon_oracle(test::icosphere(3, 5));
  for (Start start : {Start::kSeeds, Start::kPersistent}) {
    RunReport report;
    DelSurfOptions options = options_for(2, {start, Restricted::kAll, 4});
    options.surface.min_ball_radius = 0.1;
    EXPECT_EQ(test::topology_of(mesh_of(*voxels, options, report)).euler, 0);
    const SurfaceMesh sphere = mesh_of(*polygons, options, report);
    EXPECT_EQ(test::topology_of(sphere).euler, 2);
    EXPECT_EQ(two_faced_facets(*polygons, sphere.points), 0u);

    DelTetSurfOptions tets;
    tets.surface = options.surface;
    tets.tets.cell_size = 2;
    tets.variant = options.variant;
    const TetMesh mesh = deltetsurf(*voxels, tets, report);
    test::expect_finished(report);
    test::expect_all_checks_hold(mesh);
    test::expect_good_tets(mesh, 2);
  }
}

}  // namespace
}  // namespace delvox
