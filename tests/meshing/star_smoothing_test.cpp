#include "meshing/star_smoothing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "support/shapes.h"

namespace delvox {
namespace {

TEST(StarSmoothing, DisplacesVerticesButNotThoseOfSharpEdges) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(16));
  DelTetSurfOptions options;
  options.surface.size = options.tets.cell_size = 2;
  options.surface.min_angle_degrees = 20;
  RunReport report;
  TetMesh mesh = deltetsurf(*oracle, options, report);
  const TetLimits tets(15, {1e3, 100.0});
  SurfaceCriteria loose;
  loose.size = 4;
  loose.min_angle_degrees = 1;
  const SurfaceLimits surface(*oracle, loose);
  const Triangle named = mesh.boundary[0];
  const Vector3 step{0.01, 0.02, 0.01};
  const auto displacements = [&] {
    RepairMesh repair(mesh);
    CrossingGuard guard(repair);
    StarSmoothing smoothing(repair, tets, surface, guard);
    Point3 place;
    std::vector<double> gains;
    for (std::uint32_t v : named) gains.push_back(smoothing.displace(v, step, place));
    repair.finish();
    return gains;
  };
  for (double gain : displacements()) EXPECT_TRUE(std::isfinite(gain)) << gain;
  mesh.features = {{named[0], named[1]}};
  const std::vector<double> gains = displacements();
  EXPECT_EQ(gains[0], -INFINITY);
  EXPECT_EQ(gains[1], -INFINITY);
  EXPECT_TRUE(std::isfinite(gains[2])) << gains[2];
}

}  // namespace
}  // namespace delvox
