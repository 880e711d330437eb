#include "meshing/crossing_guard.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

/// Two blocks of cubes with a gap of 0.1 along x.
TetMesh two_blocks() {
  TetMesh mesh = test::cube_mesh(3);
  const TetMesh other = test::cube_mesh(3, 1, {3.1, 0, 0});
  const auto base = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (Tet tet : other.tets) {
    for (std::uint32_t& v : tet) v += base;
    mesh.tets.push_back(tet);
  }
  mesh.boundary = boundary_of(mesh.tets);
  return mesh;
}

std::uint32_t vertex_at(const TetMesh& mesh, const Point3& p) {
  return static_cast<std::uint32_t>(std::find(mesh.points.begin(), mesh.points.end(), p) - mesh.points.begin());
}

bool fan_crosses(CrossingGuard& guard, const RepairMesh& mesh, std::uint32_t vertex, const Point3& place) {
  const auto fan = mesh.fan(vertex);
  return std::any_of(fan.begin(), fan.end(),
                     [&](std::uint32_t t) { return guard.crosses(mesh.triangle(t), vertex, place, fan); });
}

TEST(CrossingGuard, SeesANodeThatIsPushedThroughTheSurfaceBesideIt) {
  TetMesh tets = two_blocks();
  const RepairMesh mesh(tets);
  CrossingGuard guard(mesh);
  const std::uint32_t v = vertex_at(tets, {3, 1, 1});
  EXPECT_FALSE(fan_crosses(guard, mesh, v, {3.09, 1.2, 1.3}));
  EXPECT_TRUE(fan_crosses(guard, mesh, v, {3.11, 1.2, 1.3}));
  EXPECT_TRUE(fan_crosses(guard, mesh, v, {3.1, 1.2, 1.3})) << "touches";
}

TEST(CrossingGuard, KnowsTrianglesThatHaveMovedSinceItWasMade) {
  TetMesh tets = two_blocks();
  RepairMesh mesh(tets);
  CrossingGuard guard(mesh);
  const std::uint32_t v = vertex_at(tets, {3, 1, 1}), w = vertex_at(tets, {3.1, 1, 1});
  ASSERT_LT(w, tets.points.size());
  EXPECT_FALSE(fan_crosses(guard, mesh, v, {3.05, 1, 1}));
  mesh.move(w, {3.02, 1, 1});
  guard.changed(mesh.fan(w));
  EXPECT_TRUE(fan_crosses(guard, mesh, v, {3.05, 1, 1}));
  mesh.move(w, {3.5, 1, 1});
  guard.changed(mesh.fan(w));
  EXPECT_FALSE(fan_crosses(guard, mesh, v, {3.2, 1, 1}));
}

}  // namespace
}  // namespace delvox
