#include "meshing/repair_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh_expectations.h"
#include "support/random.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

std::vector<std::uint32_t> sorted(std::span<const std::uint32_t> list) {
  std::vector<std::uint32_t> copy(list.begin(), list.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

std::vector<std::uint32_t> tets_at(const TetMesh& mesh, std::uint32_t vertex) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    if (std::count(mesh.tets[t].begin(), mesh.tets[t].end(), vertex) > 0) result.push_back(t);
  }
  return result;
}

/// Splits a tet in four around its centroid.
Change split(RepairMesh& mesh, std::uint32_t tet) {
  const Tet t = mesh.tet(tet);
  const Point3 middle = 0.25 * ((mesh.point(t[0]) + mesh.point(t[1])) + (mesh.point(t[2]) + mesh.point(t[3])));
  const std::uint32_t v = mesh.add_vertex(middle, false);
  Change change;
  change.old_tets = {tet};
  for (int i = 0; i < 4; ++i) {
    Tet part = t;
    part[i] = v;
    change.new_tets.push_back(part);
  }
  return change;
}

TEST(RepairMesh, KnowsWhatMeetsAtEachVertexThroughManyChanges) {
  TetMesh tets = test::cube_mesh(3);
  RepairMesh mesh(tets);
  for (std::uint32_t step = 0; step < 50; ++step) mesh.apply(split(mesh, (7 * step) % 162));
  for (std::uint32_t v = 0; v < tets.points.size(); ++v) EXPECT_EQ(sorted(mesh.star(v)), tets_at(tets, v)) << v;
  mesh.finish();
  EXPECT_EQ(tets.tets.size(), 162u + 3 * 50);
  test::expect_all_checks_hold(tets);
}

TEST(RepairMesh, TakesATrialBackToTheLastNumber) {
  TetMesh tets = test::cube_mesh(3);
  tets.on_surface.assign(tets.points.size(), 1);
  RepairMesh mesh(tets);
  mesh.apply(split(mesh, 11));
  const TetMesh before = tets;
  const auto live_tets = [&] {
    std::vector<Tet> live;
    for (std::uint32_t t = 0; t < tets.tets.size(); ++t) {
      if (mesh.alive(t)) live.push_back(tets.tets[t]);
    }
    return live;
  };
  mesh.begin_trial();
  for (std::uint32_t t : {3u, 5u, 11u, 100u}) {
    mesh.apply(split(mesh, t));
    mesh.move(t, {1.25, 0.5, 0.5});
    mesh.apply(split(mesh, mesh.added_tets()[1]));
  }
  Change vanishing;
  vanishing.old_tets = {40, 7};
  vanishing.old_triangles = {0, 2};
  mesh.apply(vanishing);
  mesh.undo_trial();
  EXPECT_EQ(tets.points, before.points);
  EXPECT_EQ(tets.on_surface, before.on_surface);
  EXPECT_EQ(live_tets(), before.tets);
  EXPECT_EQ(tets.boundary, before.boundary);
  for (std::uint32_t v = 0; v < tets.points.size(); ++v) EXPECT_EQ(sorted(mesh.star(v)), tets_at(before, v)) << v;
  mesh.finish();
  EXPECT_EQ(tets.tets, before.tets);
}

TEST(RepairMesh, ClosesTheGapsThatVanishedTetsTrianglesAndPointsLeave) {
  TetMesh tets = test::cube_mesh(2);
  tets.regions.assign(tets.tets.size(), 3);
  tets.on_surface.assign(tets.points.size(), 1);
  RepairMesh mesh(tets);
  const std::uint32_t v = mesh.add_vertex({0.3, 0.2, 0.1}, false);  // never used
  EXPECT_TRUE(mesh.star(v).empty());
  Change change;
  change.old_tets = {5};
  for (const auto& f : kTetFaces) {
    const Tet& t = mesh.tet(5);
    const std::uint32_t triangle = mesh.boundary_triangle(t[f[0]], t[f[1]], t[f[2]]);
    if (triangle != RepairMesh::kNone) {
      change.old_triangles.push_back(triangle);
    } else {
      change.new_triangles.push_back({t[f[0]], t[f[2]], t[f[1]]});
    }
  }
  mesh.apply(change);
  EXPECT_FALSE(mesh.alive(5));
  mesh.finish();
  EXPECT_EQ(tets.tets.size(), 47u);
  EXPECT_EQ(tets.regions, std::vector<Label>(47, 3));
  EXPECT_EQ(tets.points.size(), 27u);
  EXPECT_EQ(tets.on_surface.size(), 27u);
  test::expect_all_checks_hold(tets);
}

}  // namespace
}  // namespace delvox
