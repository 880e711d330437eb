#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "phantom_cases.h"

// Folds of the surface that tets would have to fit into.

namespace delvox {
namespace {

using test::PhantomCase;

/// The smallest angle of the inside between two triangles of the boundary.
double sharpest_fold(const TetMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, std::vector<Triangle>> edges;
  for (const Triangle& t : mesh.boundary) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back(Triangle{a, b, t[(i + 2) % 3]});
    }
  }
  double sharpest = 360;
  for (const auto& [edge, sides] : edges) {
    EXPECT_EQ(sides.size(), 2u);
    const auto normal = [&](const Triangle& t) {
      const Vector3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
      return (1 / norm(n)) * n;
    };
    const Vector3 m = normal(sides[0]), n = normal(sides[1]);
    const double turn = std::acos(std::clamp(dot(m, n), -1.0, 1.0)) * 180 / std::numbers::pi;
    const bool convex = dot(m, mesh.points[sides[1][2]] - mesh.points[edge[0]]) < 0;
    sharpest = std::min(sharpest, convex ? 180 - turn : 180 + turn);
  }
  return sharpest;
}

DelTetSurfOptions options_for(double size, double min_ball_radius, double min_fold_degrees) {
  DelTetSurfOptions options;
  options.surface.size = size;
  options.surface.min_ball_radius = min_ball_radius;
  options.tets.cell_size = size;
  options.min_fold_degrees = min_fold_degrees;
  return options;
}

class FoldsOfPhantoms : public testing::TestWithParam<PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(Phantoms, FoldsOfPhantoms,
                         testing::Values(PhantomCase{"plate", test::cubic_image(32), 2.6},
                                         PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(24), 0.7), 1.5},
                                         PhantomCase{"random", test::cubic_image(12), 0.8, 1.3}),
                         [](const auto& info) { return test::test_name(info.param); });

TEST_P(FoldsOfPhantoms, AreRefinedUntilThreeTetsFitIntoThem) {
  const PhantomCase& c = GetParam();
  const Volume volume = c.volume();
  const auto oracle = make_isosurface_oracle(volume, c.isosurface());
  RunReport report;
  const TetMesh before = deltetsurf(*oracle, options_for(c.size, 1e-4, 0), report);
  EXPECT_LT(sharpest_fold(before), 45) << "nothing to refine";
  const TetMesh mesh = deltetsurf(*oracle, options_for(c.size, 1e-4, 45), report);
  test::expect_finished(report);
  EXPECT_GE(sharpest_fold(mesh), 45);
  EXPECT_LT(static_cast<double>(mesh.tets.size()), 1.5 * static_cast<double>(before.tets.size()));
  test::expect_all_checks_hold(mesh);
  test::expect_good_tets(mesh, c.size);
  test::expect_good_nodes(mesh, *oracle, c.voxel());
}

// There, landmarks hold the mesh to the topology of the voxels, whose creases are all fold.
TEST(Folds, AreLeftAloneBelowSixTenthsOfAVoxel) {
  const PhantomCase c{"noisy-sphere", test::with_noise(test::cubic_image(14), 0.7), 0.5};
  const auto oracle = make_isosurface_oracle(c.volume(), c.isosurface());
  RunReport report;
  const TetMesh before = deltetsurf(*oracle, options_for(c.size, 1e-4, 0), report);
  EXPECT_LT(sharpest_fold(before), 45) << "nothing to leave";
  const TetMesh mesh = deltetsurf(*oracle, options_for(c.size, 1e-4, 45), report);
  EXPECT_EQ(mesh.points, before.points);
  EXPECT_EQ(mesh.tets, before.tets);
}

// Two planes that meet at 20 degrees, and a cap: no refinement opens that, and the smallest balls end it.
TEST(Folds, AreLeftAloneAtTheSmallestBallRadius) {
  ImplicitFunction wedge;
  const double slope = std::tan(10 * std::numbers::pi / 180);
  wedge.value = [=](const Point3& p) { return std::max({std::abs(p.z) - slope * p.x, norm(p - Point3{1, 0, 0}) - 1.2}); };
  wedge.gradient = [=](const Point3& p) {
    const Vector3 from = p - Point3{1, 0, 0};
    if (norm(from) - 1.2 > std::abs(p.z) - slope * p.x) return (1 / norm(from)) * from;
    return Vector3{-slope, 0, p.z < 0 ? -1.0 : 1.0};
  };
  wedge.box = {{-1, -2, -2}, {3, 2, 2}};
  wedge.resolution = 0.05;
  const auto oracle = make_implicit_oracle(wedge);
  RunReport report;
  const TetMesh before = deltetsurf(*oracle, options_for(0.2, 0.05, 0), report);
  const TetMesh mesh = deltetsurf(*oracle, options_for(0.2, 0.05, 45), report);
  test::expect_finished(report);
  test::expect_all_checks_hold(mesh);
  EXPECT_LT(mesh.tets.size(), 10 * before.tets.size());
}

}  // namespace
}  // namespace delvox
