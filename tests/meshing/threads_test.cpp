#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "phantom_cases.h"

// Refinement by several threads. Run under the tsan preset, these tests look for races too.

namespace delvox {
namespace {

using test::PhantomCase;

class Threads : public testing::TestWithParam<PhantomCase> {};

// A deep lattice behind thousands of walls; landmarks, links and Voronoi edges; removals of interior vertices; many
// repairs of umbrellas.
INSTANTIATE_TEST_SUITE_P(Phantoms, Threads,
                         testing::Values(PhantomCase{"sphere", test::cubic_image(36), 0.65},
                                         PhantomCase{"gyroid", test::cubic_image(16), 0.5},
                                         PhantomCase{"shells", test::cubic_image(28), 1.0},
                                         PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(14), 0.7), 0.5}),
                         [](const auto& info) { return test::test_name(info.param); });

TEST_P(Threads, OneTwoAndFourMakeTheSameMeshes) {
  const PhantomCase& c = GetParam();
  const auto oracle = make_isosurface_oracle(c.volume(), c.isosurface());
  DelTetSurfOptions options;
  options.surface.size = c.size;
  options.surface.min_ball_radius = c.min_ball_radius();
  options.tets.cell_size = c.size;
  options.min_fold_degrees = 45;
  DelSurfOptions surface_options;
  surface_options.surface = options.surface;
  TetMesh first;
  SurfaceMesh first_surface;
  for (std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    RunReport report;
    const TetMesh mesh = deltetsurf(*oracle, options, report);
    const SurfaceMesh surface = delsurf(*oracle, surface_options, report);
    if (threads == 1) {
      first = mesh;
      first_surface = surface;
      test::expect_all_checks_hold(mesh);
    }
    EXPECT_EQ(mesh.points, first.points);
    EXPECT_EQ(mesh.tets, first.tets);
    EXPECT_EQ(mesh.regions, first.regions);
    EXPECT_EQ(mesh.boundary, first.boundary);
    EXPECT_EQ(surface.points, first_surface.points);
    EXPECT_EQ(surface.triangles, first_surface.triangles);
  }
}

}  // namespace
}  // namespace delvox
