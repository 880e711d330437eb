#include "check/second_order_checks.h"

#include <gtest/gtest.h>

#include "delvox/meshing/second_order.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

TetMesh quadratic_cube() {
  TetMesh mesh = test::cube_mesh(2);
  make_second_order(mesh, nullptr);
  return mesh;
}

CheckStatus status(const TetMesh& mesh, const char* name) {
  return check_mesh(mesh).find(name)->status;
}

TEST(SecondOrderChecks, StraightTetsHold) {
  const TetMesh mesh = quadratic_cube();
  EXPECT_TRUE(check_mesh(mesh).all_hold()) << to_text(check_mesh(mesh));
  EXPECT_NEAR(check::measure_second_order(mesh).jacobian.value, 1, 1e-12);
  EXPECT_EQ(check::measure_second_order(mesh).on_boundary.size(), mesh.boundary.size() * 3 / 2);
}

TEST(SecondOrderChecks, ANodePastAQuarterTurnsATetInsideOut) {
  TetMesh mesh = quadratic_cube();
  // Beyond a quarter of the edge, the Jacobian at the end of the edge changes sign.
  const std::uint32_t a = mesh.tets[0][0], b = mesh.tets[0][1], middle = mesh.mid_nodes[0][0];
  mesh.points[middle] = mesh.points[a] + 0.26 * (mesh.points[b] - mesh.points[a]);
  EXPECT_EQ(status(mesh, "Jacobian"), CheckStatus::kPassed);
  mesh.points[middle] = mesh.points[a] + 0.24 * (mesh.points[b] - mesh.points[a]);
  EXPECT_EQ(status(mesh, "Jacobian"), CheckStatus::kFailed);
}

TEST(SecondOrderChecks, AnEdgeWithTwoNodesIsACrack) {
  TetMesh mesh = quadratic_cube();
  const std::uint32_t middle = mesh.mid_nodes[0][0];
  mesh.mid_nodes[0][0] = static_cast<std::uint32_t>(mesh.points.size());
  const Point3 twin = mesh.points[middle];
  mesh.points.push_back(twin + Point3{1e-3, 0, 0});
  EXPECT_EQ(status(mesh, "one mid-side node for each edge"), CheckStatus::kFailed);
}

TEST(SecondOrderChecks, SwappedNodesAreFound) {
  TetMesh mesh = quadratic_cube();
  std::swap(mesh.mid_nodes[3][4], mesh.mid_nodes[3][5]);  // what Gmsh's order would be
  EXPECT_EQ(status(mesh, "one mid-side node for each edge"), CheckStatus::kFailed);
}

TEST(SecondOrderChecks, ACornerIsNoMidSideNode) {
  TetMesh mesh = quadratic_cube();
  mesh.mid_nodes[0][0] = mesh.tets[0][0];
  EXPECT_EQ(status(mesh, "one mid-side node for each edge"), CheckStatus::kFailed);
  mesh = quadratic_cube();
  mesh.mid_nodes[0][0] = 1u << 30;
  EXPECT_EQ(status(mesh, "valid indices"), CheckStatus::kFailed);
  mesh = quadratic_cube();
  mesh.mid_nodes.pop_back();
  EXPECT_EQ(status(mesh, "valid indices"), CheckStatus::kFailed);
}

}  // namespace
}  // namespace delvox
