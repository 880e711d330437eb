#include "delvox/core/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "support/test_meshes.h"

namespace delvox {
namespace {

TEST(Mesh, FacesOfAPositiveTetPointOutwardAndLieOppositeTheirVertex) {
  const std::array<Point3, 4> p{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  ASSERT_GT(dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]), 0);
  for (int face = 0; face < 4; ++face) {
    const auto& f = kTetFaces[face];
    const Vector3 normal = cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]);
    EXPECT_LT(dot(normal, p[face] - p[f[0]]), 0);
    EXPECT_EQ(f[0] + f[1] + f[2] + face, 6);
  }
}

TEST(Mesh, BoundaryOfACubeIsItsTwelveTrianglesOrientedOutward) {
  const TetMesh cube = test::cube_mesh();
  const std::vector<Triangle> boundary = boundary_of(cube.tets);
  ASSERT_EQ(boundary.size(), 12u);
  double six_volumes = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> half_edges;
  for (const Triangle& t : boundary) {
    six_volumes += dot(cube.points[t[0]], cross(cube.points[t[1]], cube.points[t[2]]));
    for (int i = 0; i < 3; ++i) ++half_edges[{t[i], t[(i + 1) % 3]}];
  }
  EXPECT_DOUBLE_EQ(six_volumes, 6);
  for (const auto& [edge, count] : half_edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(half_edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(Mesh, BoundaryComesInTheOrderOfTheTets) {
  const std::vector<Tet> tets{{4, 1, 2, 3}, {0, 1, 3, 2}};
  const std::vector<Triangle> boundary = boundary_of(tets);
  ASSERT_EQ(boundary.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(std::count(boundary[i].begin(), boundary[i].end(), 4u), i < 3) << i;
    EXPECT_EQ(std::count(boundary[i].begin(), boundary[i].end(), 0u), i >= 3) << i;
  }
}

TEST(Mesh, NoTetsHaveNoBoundary) {
  EXPECT_TRUE(boundary_of({}).empty());
}

TEST(Mesh, BoundarySurfaceLeavesOutInteriorPointsAndKeepsTheTriangles) {
  TetMesh cubes = test::cube_mesh(3, 0.5, {1, 2, 3});
  cubes.info.isovalue = 40;
  const SurfaceMesh surface = boundary_surface(cubes);
  EXPECT_EQ(surface.points.size(), 64u - 8u);
  ASSERT_EQ(surface.triangles.size(), cubes.boundary.size());
  EXPECT_EQ(surface.info, cubes.info);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(surface.points[surface.triangles[t][i]], cubes.points[cubes.boundary[t][i]]);
    }
  }
  std::uint32_t next = 0;  // numbers come in the order of first use
  for (const Triangle& t : surface.triangles) {
    for (std::uint32_t v : t) {
      EXPECT_LE(v, next);
      next = std::max(next, v + 1);
    }
  }
}

TEST(Mesh, BoundarySurfaceFindsTheBoundaryThatIsNotListed) {
  TetMesh cubes = test::cube_mesh(2);
  const SurfaceMesh listed = boundary_surface(cubes);
  cubes.boundary.clear();
  const SurfaceMesh found = boundary_surface(cubes);
  EXPECT_EQ(found.triangles, listed.triangles);
  EXPECT_EQ(found.points, listed.points);
}

}  // namespace
}  // namespace delvox
