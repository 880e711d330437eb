#include "check/solver_limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/meshing/second_order.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

TetMesh one_tet(Point3 a, Point3 b, Point3 c, Point3 d) {
  TetMesh mesh;
  mesh.points = {a, b, c, d};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

std::size_t objections(const check::SolverMeasures& measures, const std::string& solver, const std::string& severity) {
  std::size_t count = 0;
  for (const SolverLimit& limit : measures.limits) {
    if (limit.solver == solver && limit.severity == severity) count += limit.count;
  }
  return count;
}

TEST(SolverLimits, TheRegularTetIsPerfect) {
  const auto m = check::measure_for_solvers(one_tet({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}));
  EXPECT_NEAR(m.face_angles.min, 60, 1e-9);
  EXPECT_NEAR(m.face_angles.max, 60, 1e-9);
  EXPECT_NEAR(m.aspect_ratios.max, 1, 1e-9);
  EXPECT_NEAR(m.shape_factors.min, 1, 1e-9);
  for (const SolverLimit& limit : m.limits) {
    EXPECT_EQ(limit.count, 0u) << limit.measure;
  }
}

TEST(SolverLimits, FiguresOfATetWithKnownAngles) {
  // Right angles at the origin; the edges along the axes are 1, 1 and 12.
  const auto m = check::measure_for_solvers(one_tet({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 12}));
  EXPECT_NEAR(m.face_angles.min, std::atan(1.0 / 12) * 180 / std::acos(-1.0), 1e-9);
  EXPECT_NEAR(m.face_angles.max, 90, 1e-9);
  EXPECT_EQ(objections(m, "Abaqus", "warning"), 2u) << "a small angle and an edge of twelve times another";
  EXPECT_EQ(objections(m, "ANSYS", "error"), 0u);
}

TEST(SolverLimits, AFlatTetIsObjectedToByItsShape) {
  const auto m = check::measure_for_solvers(one_tet({0, 0, 0}, {1, 0, 0}, {1, 1, 1e-4}, {0, 1, 0}));
  bool found = false;
  for (const SolverLimit& limit : m.limits) {
    if (limit.measure != "shape factor") continue;
    found = true;
    EXPECT_EQ(limit.count, 1u);
    EXPECT_NEAR(limit.where.x, 0.5, 1e-9);
  }
  EXPECT_TRUE(found);
}

TEST(SolverLimits, ABentTetHasAJacobianRatio) {
  TetMesh mesh = test::cube_mesh(2);
  EXPECT_EQ(check::measure_for_solvers(mesh).jacobian_ratios.count, 0u) << "of no interest for straight tets";
  make_second_order(mesh, nullptr);
  EXPECT_NEAR(check::measure_for_solvers(mesh).jacobian_ratios.max, 1, 1e-9);
  const std::uint32_t a = mesh.tets[0][0], b = mesh.tets[0][1], middle = mesh.mid_nodes[0][0];
  mesh.points[middle] = mesh.points[a] + 0.2501 * (mesh.points[b] - mesh.points[a]);
  EXPECT_GT(objections(check::measure_for_solvers(mesh), "ANSYS", "warning"), 0u);
}

TEST(SolverLimits, AreInTheFullReportOnly) {
  const TetMesh mesh = test::cube_mesh(2);
  CheckOptions cheap;
  cheap.level = CheckLevel::kCheap;
  EXPECT_TRUE(check_mesh(mesh, cheap).solver_limits.empty());
  const CheckReport report = check_mesh(mesh);
  EXPECT_FALSE(report.solver_limits.empty());
  EXPECT_NE(to_text(report).find("solvers"), std::string::npos);
}

}  // namespace
}  // namespace delvox
