#include "delvox/meshing/second_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "delvox/check/check_mesh.h"
#include "delvox/meshing/deltetsurf.h"
#include "support/shapes.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

using test::cube_mesh;
using test::unit_ball;

TetMesh mesh_of(const Oracle& oracle, double size) {
  DelTetSurfOptions options;
  options.surface.size = size;
  options.tets.cell_size = size;
  RunReport report;
  return deltetsurf(oracle, options, report);
}

TEST(SecondOrder, WithoutAnOracleEveryEdgeGetsItsMiddleOnce) {
  TetMesh mesh = cube_mesh(3);
  make_second_order(mesh, nullptr);
  ASSERT_EQ(mesh.mid_nodes.size(), mesh.tets.size());
  std::map<std::uint32_t, std::array<std::uint32_t, 2>> edge_of;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t e = 0; e < 6; ++e) {
      const std::uint32_t a = mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][0])];
      const std::uint32_t b = mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][1])];
      EXPECT_EQ(mesh.points[mesh.mid_nodes[t][e]], midpoint(mesh.points[a], mesh.points[b]));
      const std::array<std::uint32_t, 2> edge{std::min(a, b), std::max(a, b)};
      EXPECT_EQ(edge_of.try_emplace(mesh.mid_nodes[t][e], edge).first->second, edge);
    }
  }
  // Vertices - edges + faces - tets = 1 for a ball, and faces = (4 tets + boundary) / 2.
  const std::size_t edges = edge_of.size(), corners = 4 * 4 * 4;
  EXPECT_EQ(corners + (4 * mesh.tets.size() + mesh.boundary.size()) / 2, 1 + edges + mesh.tets.size());
  EXPECT_EQ(mesh.points.size(), corners + edges);
}

TEST(SecondOrder, FirstOrderUndoesIt) {
  TetMesh mesh = cube_mesh(2);
  const TetMesh before = mesh;
  make_second_order(mesh, nullptr);
  mesh.sets = {{"all", {}, {}, {}}};
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) mesh.sets[0].nodes.push_back(i);
  make_first_order(mesh);
  EXPECT_EQ(mesh.points, before.points);
  EXPECT_EQ(mesh.tets, before.tets);
  EXPECT_EQ(mesh.boundary, before.boundary);
  EXPECT_TRUE(mesh.mid_nodes.empty());
  EXPECT_EQ(mesh.sets[0].nodes.size(), before.points.size());
}

TEST(SecondOrder, BoundaryMiddlesLieOnTheSurfaceAndTheRestInTheMiddle) {
  const auto ball = unit_ball();
  TetMesh mesh = mesh_of(*ball, 0.3);
  const std::size_t corners = mesh.points.size();
  const SecondOrderReport report = make_second_order(mesh, ball.get());
  EXPECT_EQ(report.boundary_edges, 3 * mesh.boundary.size() / 2);
  EXPECT_EQ(report.not_found, 0u);
  EXPECT_EQ(report.on_surface + report.straightened, report.boundary_edges);
  EXPECT_GT(report.on_surface, report.boundary_edges * 9 / 10);
  std::size_t on_surface = 0;
  for (std::size_t i = corners; i < mesh.points.size(); ++i) {
    if (mesh.on_surface[i] == 0) continue;
    ++on_surface;
    EXPECT_NEAR(norm(mesh.points[i]), 1, 1e-9);
  }
  EXPECT_EQ(on_surface, report.on_surface);
  const CheckReport check = check_mesh(mesh);
  EXPECT_TRUE(check.all_hold()) << to_text(check);
  ASSERT_NE(check.find("Jacobian"), nullptr);
  EXPECT_EQ(check.find("Jacobian")->status, CheckStatus::kPassed);
}

TEST(SecondOrder, AMeshMuchCoarserThanItsSurfaceIsStraightenedRatherThanInverted) {
  const PhantomOptions image = test::cubic_image(40);
  const auto oracle = test::voxel_phantom_oracle("random", image);
  DelTetSurfOptions options;
  options.surface.size = options.tets.cell_size = 6;
  options.surface.min_ball_radius = 0.5;
  RunReport run;
  TetMesh mesh = deltetsurf(*oracle, options, run);
  const SecondOrderReport report = make_second_order(mesh, oracle.get());
  EXPECT_GT(report.straightened + report.not_found, 0u);
  const CheckReport check = check_mesh(mesh);
  EXPECT_EQ(check.find("Jacobian")->status, CheckStatus::kPassed);
  EXPECT_EQ(check.find("one mid-side node for each edge")->status, CheckStatus::kPassed);
}

}  // namespace
}  // namespace delvox
