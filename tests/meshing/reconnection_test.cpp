#include "meshing/reconnection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "delvox/check/check_mesh.h"
#include "mesh_expectations.h"
#include "support/shapes.h"

namespace delvox {
namespace {

constexpr double kPi = std::numbers::pi;

/// Edge from (0, 0, -height) to (0, 0, height), with `n` corners around it on a circle of radius 1: the edge's tets.
TetMesh ring_mesh(int n, double height) {
  TetMesh mesh;
  mesh.points = {{0, 0, -height}, {0, 0, height}};
  for (int i = 0; i < n; ++i) mesh.points.push_back({std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0});
  for (int i = 0; i < n; ++i) {
    mesh.tets.push_back({0, 1, static_cast<std::uint32_t>(2 + i), static_cast<std::uint32_t>(2 + (i + 1) % n)});
  }
  mesh.boundary = boundary_of(mesh.tets);
  return mesh;
}

class Reconnections : public testing::Test {
 protected:
  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle("sphere", test::cubic_image(16));
  SurfaceCriteria criteria_;
  TetLimits tets_{20, {1e3, 100.0}};
  SurfaceLimits surface_{*oracle_, criteria_};
};

TEST_F(Reconnections, TakeOutABadEdgeWithRingsOfThreeToNineCornersAndFillTheSameSpace) {
  for (int n = 3; n <= 9; ++n) {
    SCOPED_TRACE(n);
    TetMesh mesh = ring_mesh(n, 1);
    mesh.points[0].x = mesh.points[1].x = 0.95;  // all but touches a corner: two tets are flat
    const CheckReport before = check_mesh(mesh);
    RepairMesh repair(mesh);
    CrossingGuard guard(repair);
    Change change;
    ASSERT_GT(Reconnection(repair, tets_, surface_, guard).remove_edge(0, 1, 0, change), 0);
    EXPECT_EQ(change.old_tets.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(change.new_tets.size(), 2 * (static_cast<std::size_t>(n) - 2));
    repair.apply(change);
    repair.finish();
    const CheckReport after = check_mesh(mesh);
    EXPECT_NEAR(after.statistics.volume_mm3, before.statistics.volume_mm3, 1e-12);
    EXPECT_GT(after.statistics.dihedral_degrees.min, before.statistics.dihedral_degrees.min);
    test::expect_all_checks_hold(mesh);
  }
}

TEST_F(Reconnections, LeaveAGoodEdgeAndOneWithoutWhichABoundWouldBreak) {
  TetMesh good = ring_mesh(6, 0.6), bad = ring_mesh(5, 1);
  bad.points[0].x = bad.points[1].x = 0.95;
  const TetLimits strict(20, {2, 0.5});  // circumradii of half the ring's
  for (TetMesh* mesh : {&good, &bad}) {
    const RepairMesh repair(*mesh);
    CrossingGuard guard(repair);
    Change change;
    Reconnection reconnection(repair, mesh == &good ? tets_ : strict, surface_, guard);
    EXPECT_LT(reconnection.remove_edge(0, 1, 0, change), 0);
  }
}

TEST_F(Reconnections, PutAnEdgeInPlaceOfFacesAndThatIsUndoneByTakingItOut) {
  // Five corners around: as ten tets without the edge, two of them at each inner face; with it, five.
  TetMesh mesh = ring_mesh(5, 0.6);
  TetMesh without = mesh;
  TetLimits lenient(89, {1e3, 100.0});
  without.tets = {{2, 3, 4, 1}, {3, 2, 4, 0}, {2, 4, 5, 1}, {4, 2, 5, 0}, {2, 5, 6, 1}, {5, 2, 6, 0}};
  without.boundary = boundary_of(without.tets);
  RepairMesh repair(without);
  CrossingGuard guard(repair);
  Change change;
  Reconnection reconnection(repair, lenient, surface_, guard);
  double best = 0;
  for (std::uint32_t t = 0; t < 6; ++t) {
    for (int face = 0; face < 4; ++face) {
      Change candidate;
      const double gain = reconnection.remove_faces(t, face, 0, candidate);
      if (gain > best) {
        best = gain;
        change = candidate;
      }
    }
  }
  ASSERT_GT(best, 0);
  EXPECT_EQ(change.old_tets.size(), 6u) << "all three faces go at once";
  repair.apply(change);
  repair.finish();
  EXPECT_EQ(without.tets.size(), 5u);
  EXPECT_NEAR(check_mesh(without).statistics.volume_mm3, check_mesh(mesh).statistics.volume_mm3, 1e-12);
  test::expect_all_checks_hold(without);
}

}  // namespace
}  // namespace delvox
