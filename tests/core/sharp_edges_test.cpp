#include "delvox/core/sharp_edges.h"

#include <gtest/gtest.h>

#include "support/sharp_shapes.h"

namespace delvox {
namespace {

std::size_t count(const SurfaceMesh& mesh, double degrees) {
  return sharp_edges(mesh.points, mesh.triangles, degrees).size();
}

TEST(SharpEdges, ThoseOfACubeAreAtNinetyDegreesItsDiagonalsAtNone) {
  const SurfaceMesh cube = boundary_surface(test::cube_mesh());
  EXPECT_EQ(count(cube, 89.999), 12u);
  EXPECT_EQ(count(cube, 1e-6), 12u);
  EXPECT_EQ(count(cube, 90.001), 0u);
}

TEST(SharpEdges, TheAngleIsThatBetweenNormals) {
  // The facets of an icosahedron meet at 138.19 degrees: their normals are 41.81 apart.
  const SurfaceMesh icosahedron = test::icosphere(0);
  EXPECT_EQ(count(icosahedron, 41.8), 30u);
  EXPECT_EQ(count(icosahedron, 41.82), 0u);
  // At the edge of a wedge of 20 degrees they are 160 apart.
  EXPECT_EQ(count(test::wedge(20), 159.9), 1u);
  EXPECT_EQ(count(test::wedge(20), 160.1), 0u);
}

TEST(SharpEdges, WhichWayTrianglesFaceMakesNoDifference) {
  SurfaceMesh cube = boundary_surface(test::cube_mesh());
  const std::vector<SharpEdge> before = sharp_edges(cube.points, cube.triangles, 60);
  for (std::size_t t = 0; t < cube.triangles.size(); t += 3) std::swap(cube.triangles[t][1], cube.triangles[t][2]);
  const std::vector<SharpEdge> after = sharp_edges(cube.points, cube.triangles, 60);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].ends, before[i].ends);
    EXPECT_EQ(after[i].triangles, before[i].triangles);
  }
}

}  // namespace
}  // namespace delvox
