#include "delvox/core/mesh_sets.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/test_meshes.h"

namespace delvox {
namespace {

using test::cube_mesh;

MeshSet find(const TetMesh& mesh, const SetRule& rule) {
  return select_sets(mesh, {{"it", rule}}).at(0);
}

double area(const TetMesh& mesh, const MeshSet& set) {
  double sum = 0;
  for (TetFace face : set.faces) {
    const Triangle t = face_corners(mesh.tets, face);
    sum += norm(cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]])) / 2;
  }
  return sum;
}

TEST(MeshSets, APlaneTakesWhatLiesBeyondIt) {
  const TetMesh mesh = cube_mesh(4);
  const MeshSet set = find(mesh, PlaneRule{{0, 0, 3}, {0, 0, 9}});
  EXPECT_EQ(set.name, "it");
  EXPECT_EQ(set.nodes.size(), 2u * 25u);
  EXPECT_EQ(set.tets.size(), 16u * 6u);
  EXPECT_DOUBLE_EQ(area(mesh, set), 16 + 4 * 4);
}

TEST(MeshSets, APlaneWithAThicknessTakesWhatIsNear) {
  const TetMesh mesh = cube_mesh(4);
  const MeshSet set = find(mesh, PlaneRule{{0, 0, 4}, {0, 0, -1}, 0.1});
  EXPECT_EQ(set.nodes.size(), 25u);
  EXPECT_TRUE(set.tets.empty());
  EXPECT_DOUBLE_EQ(area(mesh, set), 16);
}

TEST(MeshSets, BoxAndSphereTakeTheirInside) {
  const TetMesh mesh = cube_mesh(4);
  EXPECT_EQ(find(mesh, BoxRule{{{-1, -1, -1}, {2, 2, 0.5}}}).nodes.size(), 9u);
  EXPECT_EQ(find(mesh, BoxRule{{{0, 0, 0}, {2, 2, 2}}}).tets.size(), 8u * 6u);
  EXPECT_EQ(find(mesh, SphereRule{{2, 2, 2}, 1}).nodes.size(), 7u);
  EXPECT_TRUE(find(mesh, SphereRule{{2, 2, 2}, 1}).faces.empty());
}

TEST(MeshSets, AllIsEverything) {
  const TetMesh mesh = cube_mesh(2);
  const MeshSet set = find(mesh, AllRule{});
  EXPECT_EQ(set.nodes.size(), mesh.points.size());
  EXPECT_EQ(set.tets.size(), mesh.tets.size());
  EXPECT_EQ(set.faces.size(), mesh.boundary.size());
}

TEST(MeshSets, ANormalTakesTheFacesThatLookThatWay) {
  const TetMesh mesh = cube_mesh(3);
  const MeshSet up = find(mesh, NormalRule{{0, 0, 2}, 10});
  EXPECT_DOUBLE_EQ(area(mesh, up), 9);
  EXPECT_EQ(up.nodes.size(), 16u);
  EXPECT_FALSE(up.tets.empty());
  EXPECT_DOUBLE_EQ(area(mesh, find(mesh, NormalRule{{1, 1, 1}, 60})), 27);
  EXPECT_DOUBLE_EQ(area(mesh, find(mesh, NormalRule{{1, 1, 1}, 180})), 54);
}

TEST(MeshSets, ABorderTakesWhatLooksOutBeyondIt) {
  const TetMesh mesh = cube_mesh(3);
  EXPECT_DOUBLE_EQ(area(mesh, find(mesh, BorderRule{{2.5, 0, 0}, {1, 0, 0}})), 9);
  EXPECT_TRUE(find(mesh, BorderRule{{3.5, 0, 0}, {1, 0, 0}}).nodes.empty());
}

TEST(MeshSets, NearDoesNotJumpAGap) {
  TetMesh mesh = cube_mesh(2);
  const TetMesh other = cube_mesh(2, 1, {0, 0, 2.1});  // over a gap of 0.1
  for (const Tet& tet : other.tets) {
    Tet moved = tet;
    for (std::uint32_t& v : moved) v += static_cast<std::uint32_t>(mesh.points.size());
    mesh.tets.push_back(moved);
  }
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  const MeshSet set = find(mesh, NearRule{{1, 1, 1.95}, 1.5});
  EXPECT_GE(area(mesh, set), 4);
  for (std::uint32_t v : set.nodes) EXPECT_LE(mesh.points[v].z, 2);
}

TEST(MeshSets, ListsRise) {
  const TetMesh mesh = cube_mesh(3);
  for (const SetRule& rule :
       {SetRule{AllRule{}}, SetRule{NormalRule{{1, 1, 1}, 90}}, SetRule{NearRule{{0, 0, 0}, 2}}}) {
    const MeshSet set = find(mesh, rule);
    EXPECT_TRUE(std::is_sorted(set.nodes.begin(), set.nodes.end()));
    EXPECT_TRUE(std::is_sorted(set.tets.begin(), set.tets.end()));
    EXPECT_TRUE(std::is_sorted(set.faces.begin(), set.faces.end()));
    EXPECT_FALSE(set.faces.empty());
  }
}

}  // namespace
}  // namespace delvox
