#include "delvox/meshing/deltetsurf.h"

#include <gtest/gtest.h>

#include "mesh_expectations.h"
#include "phantom_cases.h"

namespace delvox {
namespace {

using test::PhantomCase;

class DelTetSurfOnPhantoms : public testing::TestWithParam<PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(
    Phantoms, DelTetSurfOnPhantoms,
    testing::Values(PhantomCase{"sphere", test::cubic_image(32), 2},
                    PhantomCase{"ellipsoid", test::cubic_image(32), 1.5},
                    PhantomCase{"torus", test::cubic_image(32), 1.2}, PhantomCase{"shells", test::cubic_image(28), 1.5},
                    PhantomCase{"touching-balls", test::cubic_image(32), 1.2},
                    PhantomCase{"plate", test::cubic_image(28), 0.8}, PhantomCase{"rod", test::cubic_image(28), 0.8},
                    PhantomCase{"oblique-sphere", test::oblique_image(), 1.5},
                    PhantomCase{"border", test::cubic_image(28), 1.5}, PhantomCase{"ramp", test::cubic_image(14), 1.2},
                    PhantomCase{"gyroid", test::cubic_image(20), 0.5},
                    PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(12), 0.7), 0.5},
                    PhantomCase{"random", test::cubic_image(7), 0.5, 1.3}),
    [](const auto& info) { return test::test_name(info.param); });

TEST_P(DelTetSurfOnPhantoms, GivesPositiveTetsInAManifoldOfTheRightTopologyWithinAllBoundsTwiceAlike) {
  const PhantomCase& c = GetParam();
  const Volume volume = c.volume();
  const auto oracle = make_isosurface_oracle(volume, c.isosurface());
  DelTetSurfOptions options;
  options.surface.size = c.size;
  options.surface.min_ball_radius = c.min_ball_radius();
  options.tets.cell_size = c.size;
  RunReport report;
  const TetMesh mesh = deltetsurf(*oracle, options, report);
  test::expect_finished(report);
  EXPECT_TRUE(mesh.info.complete);
  test::expect_all_checks_hold(mesh);
  test::expect_good_tets(mesh, c.size);
  test::expect_good_nodes(mesh, *oracle, c.voxel());
  EXPECT_EQ(mesh.regions, std::vector<Label>(mesh.tets.size(), 1));

  const SurfaceMesh surface = boundary_surface(mesh);
  test::expect_closed_manifold(surface);
  test::expect_good_triangles(surface, c.size);
  const test::SurfaceTopology found = test::topology_of(surface);
  const VoxelTopology voxels = count_topology(volume, c.isosurface());
  EXPECT_EQ(found.components, voxels.surface_components);
  EXPECT_EQ(found.euler, voxels.euler);
  const PhantomTruth truth = phantom_truth(c.kind, c.image);
  if (truth.components && !c.isovalue) {
    EXPECT_EQ(found.components, static_cast<std::size_t>(*truth.components));
  }
  if (truth.euler && !c.isovalue) {
    EXPECT_EQ(found.euler, *truth.euler);
  }

  RunReport second_report;
  const TetMesh second = deltetsurf(*oracle, options, second_report);
  EXPECT_EQ(second.points, mesh.points);
  EXPECT_EQ(second.tets, mesh.tets);
  EXPECT_EQ(second.boundary, mesh.boundary);
  EXPECT_EQ(second.on_surface, mesh.on_surface);
}

TEST(DelTetSurf, CellSizeAloneMakesTheInsideFiner) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(24));
  std::size_t before = 0;
  for (double cell_size : {4.0, 2.0, 1.0}) {
    DelTetSurfOptions options;
    options.surface.size = 2;
    options.tets.cell_size = cell_size;
    RunReport report;
    const TetMesh mesh = deltetsurf(*oracle, options, report);
    test::expect_finished(report);
    test::expect_good_tets(mesh, cell_size);
    EXPECT_GT(mesh.tets.size(), before);
    before = mesh.tets.size();
  }
}

TEST(DelTetSurf, ACellSizeWithoutBoundStillKeepsTheRadiusEdgeRatio) {
  const auto oracle = test::voxel_phantom_oracle("ellipsoid", test::cubic_image(24));
  DelTetSurfOptions options;
  options.surface.size = 1;
  options.tets.cell_size = 1e6;
  RunReport report;
  const TetMesh mesh = deltetsurf(*oracle, options, report);
  test::expect_finished(report);
  test::expect_good_tets(mesh, 1e6);
}

// Splitting each surface ball that a circumcentre encroaches on would give it a sixth more.
TEST(DelTetSurf, TheSurfaceGetsFewVerticesThatItDoesNotNeedItself) {
  const auto oracle = test::voxel_phantom_oracle("gyroid", test::cubic_image(32));
  DelTetSurfOptions options;
  options.surface.size = options.tets.cell_size = 1;
  RunReport report;
  const SurfaceMesh surface = delsurf(*oracle, {options.surface, {}}, report);
  const TetMesh mesh = deltetsurf(*oracle, options, report);
  test::expect_finished(report);
  const auto on_surface = std::count(mesh.on_surface.begin(), mesh.on_surface.end(), std::uint8_t{1});
  EXPECT_LT(static_cast<double>(on_surface), 1.1 * static_cast<double>(surface.points.size()));
}

TEST(DelTetSurf, TheReportCountsWhatWasDone) {
  const auto oracle = test::voxel_phantom_oracle("shells", test::cubic_image(24));
  DelTetSurfOptions options;
  options.surface.size = 2;
  options.tets.cell_size = 2;
  RunReport report;
  report.surface_insertions = 12345;  // of an earlier run: must not stay
  const TetMesh mesh = deltetsurf(*oracle, options, report);
  EXPECT_EQ(report.components, 3u);
  EXPECT_LT(report.surface_insertions, 12345u);
  EXPECT_GT(report.interior_insertions, 0u);
  std::size_t interior = 0;
  for (std::uint8_t on : mesh.on_surface) interior += on == 0;
  EXPECT_LE(interior, report.interior_insertions - report.removals);
  ASSERT_FALSE(report.stages.empty());
  EXPECT_EQ(report.stages.front().stage, "seeds");
}

}  // namespace
}  // namespace delvox
