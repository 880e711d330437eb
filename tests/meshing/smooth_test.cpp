// Smooth (book, 14.4): bounds on the roughness of edges, measured on the meshes themselves.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/meshing/remove_slivers.h"
#include "delvox/oracle/polygon_oracle.h"
#include "mesh_expectations.h"
#include "support/shapes.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

std::unique_ptr<SmoothOracle> torus() {
  return test::implicit_phantom_oracle("torus", test::cubic_image(32), 0.5);
}

SurfaceMesh mesh_torus(const SurfaceCriteria& criteria, RunReport& report) {
  return test::closed_surface(*torus(), criteria, 0, report);
}

TEST(Smooth, NoEdgeIsRougherThanAskedForAndTheMeshSaysSo) {
  SurfaceCriteria criteria;
  criteria.size = 2;
  RunReport report;
  const SurfaceMesh plain = mesh_torus(criteria, report);
  EXPECT_GT(test::largest_roughness_degrees(plain), 20);
  EXPECT_EQ(report.smooth_insertions, 0u);
  EXPECT_FALSE(plain.info.promises.max_roughness_degrees);
  std::size_t before = plain.triangles.size();
  for (double bound : {20.0, 10.0, 5.0}) {
    criteria.max_roughness_degrees = bound;
    const SurfaceMesh mesh = mesh_torus(criteria, report);
    EXPECT_LE(test::largest_roughness_degrees(mesh), bound);
    EXPECT_EQ(mesh.info.promises.max_roughness_degrees, bound);
    EXPECT_TRUE(report.unmet.empty());
    EXPECT_GT(report.smooth_insertions, 0u);
    EXPECT_GT(mesh.triangles.size(), before);
    before = mesh.triangles.size();
    test::expect_good_triangles(mesh, 2);
    test::expect_all_checks_hold(mesh);
  }
}

// Figure 14.7: Smooth alone, without Quality.
TEST(Smooth, NeedsNoQuality) {
  SurfaceCriteria criteria;
  criteria.size = 3;
  criteria.min_angle_degrees = 0;
  criteria.max_roughness_degrees = 12;
  RunReport report;
  EXPECT_LE(test::largest_roughness_degrees(mesh_torus(criteria, report)), 12);
}

TEST(Smooth, TetsKeepItThroughRemovalOfSlivers) {
  const auto oracle = torus();
  DelTetSurfOptions options;
  options.surface.size = 2;
  options.surface.max_roughness_degrees = 12;
  options.tets.cell_size = 2;
  RunReport report;
  TetMesh mesh = deltetsurf(*oracle, options, report);
  test::expect_finished(report);
  EXPECT_LE(test::largest_roughness_degrees(boundary_surface(mesh)), 12);
  const SliverReport slivers = remove_slivers(mesh, *oracle, {20, options.surface, options.tets, {}}, report);
  EXPECT_GT(slivers.slivers, 50u);
  EXPECT_GT(slivers.moves + slivers.reconnections, 50u);
  EXPECT_LE(test::largest_roughness_degrees(boundary_surface(mesh)), 12);
  EXPECT_EQ(mesh.info.promises.max_roughness_degrees, 12);
  test::expect_all_checks_hold(mesh);
}

// Its edges are right angles however small the triangles.
TEST(Smooth, LeavesSharpEdgesAtTheSmallestBallCountsThemAndPromisesNothing) {
  const auto cube = make_polygon_oracle(boundary_surface(test::cube_mesh(1, 10)));
  DelSurfOptions options;
  options.surface.size = 2;
  options.surface.max_roughness_degrees = 30;
  options.surface.min_smooth_radius = 0.3;
  options.surface.min_ball_radius = 0.002;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*cube, options, report);
  EXPECT_TRUE(report.succeeded());
  test::expect_closed_manifold(mesh);
  std::size_t left = 0;
  for (const Unmet& unmet : report.unmet) {
    if (unmet.criterion != "roughness") continue;
    left = unmet.count;
    EXPECT_FALSE(unmet.breaks_promise);
  }
  EXPECT_GT(left, 50u);
  EXPECT_EQ(left, test::rougher_edges(mesh, 30));
  EXPECT_FALSE(mesh.info.promises.max_roughness_degrees);
  double shortest = 10;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) shortest = std::min(shortest, distance(mesh.points[t[i]], mesh.points[t[(i + 1) % 3]]));
  }
  EXPECT_GT(shortest, 0.1);  // nor is anything much smaller made for them
}

TEST(Smooth, ThreadsMakeNoDifference) {
  DelTetSurfOptions options;
  options.surface.size = 1.5;
  options.surface.max_roughness_degrees = 10;
  options.tets.cell_size = 1.5;
  TetMesh first;
  for (std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    RunReport report;
    const TetMesh mesh = deltetsurf(*torus(), options, report);
    if (threads == 1) first = mesh;
    EXPECT_EQ(mesh.points, first.points);
    EXPECT_EQ(mesh.tets, first.tets);
  }
}

}  // namespace
}  // namespace delvox
