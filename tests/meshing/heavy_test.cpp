#include <gtest/gtest.h>

#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "phantom_cases.h"

// The larger runs: hundreds of thousands of tets, and the topology of noise.

namespace delvox {
namespace {

using test::PhantomCase;

void expect_everything(const PhantomCase& c) {
  const Volume volume = c.volume();
  const auto oracle = make_isosurface_oracle(volume, c.isosurface());
  DelTetSurfOptions options;
  options.surface.size = c.size;
  options.surface.min_ball_radius = 0.1 * c.voxel();
  options.tets.cell_size = c.size;
  RunReport report;
  const TetMesh mesh = deltetsurf(*oracle, options, report);
  test::expect_finished(report);
  test::expect_all_checks_hold(mesh);
  test::expect_good_tets(mesh, c.size);
  test::expect_good_nodes(mesh, *oracle, c.voxel());
  const SurfaceMesh surface = boundary_surface(mesh);
  test::expect_closed_manifold(surface);
  test::expect_good_triangles(surface, c.size);
  const test::SurfaceTopology found = test::topology_of(surface);
  const VoxelTopology voxels = count_topology(volume, c.isosurface());
  EXPECT_EQ(found.components, voxels.surface_components);
  EXPECT_EQ(found.euler, voxels.euler);
  ::testing::Test::RecordProperty("tets", static_cast<int>(mesh.tets.size()));
}

TEST(Heavy, ASphereOfHundredsOfThousandsOfTetsKeepsEveryPromise) {
  expect_everything({"sphere", test::cubic_image(64), 1.1});
}

TEST(Heavy, AGyroidAtHalfAVoxelHasTheTopologyOfItsVoxels) { expect_everything({"gyroid", test::cubic_image(40), 0.5}); }

TEST(Heavy, NoiseAtHalfAVoxelHasTheTopologyOfItsVoxels) {
  for (std::uint64_t seed : {1, 2, 3}) {
    PhantomOptions image = test::with_noise(test::cubic_image(20), 1);
    image.seed = seed;
    expect_everything({"noisy-sphere", image, 0.5});
  }
}

TEST(Heavy, RandomIntegersAtHalfAVoxelHaveTheTopologyOfTheirVoxels) {
  for (std::uint64_t seed : {1, 2, 3, 4}) {
    PhantomOptions image = test::cubic_image(14);
    image.seed = seed;
    expect_everything({"random", image, 0.5});
  }
}

TEST(Heavy, BodiesKeepEveryPromiseAtManySizes) {
  for (const char* kind : {"torus", "shells", "touching-balls", "border"}) {
    for (double size : {0.7, 0.9, 1.3, 1.9, 2.7}) {
      SCOPED_TRACE(std::string(kind) + " at size " + std::to_string(size));
      expect_everything({kind, test::cubic_image(40), size});
    }
  }
}

}  // namespace
}  // namespace delvox
