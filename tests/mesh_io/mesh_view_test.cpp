#include "mesh_io/mesh_view.h"

#include <gtest/gtest.h>

#include "mesh_io/mesh_io_support.h"

namespace delvox::mesh_io {
namespace {

MeshView view_of(const TetMesh& mesh, const std::vector<TetFace>& faces) {
  return {mesh.points, mesh.boundary, mesh.tets,      mesh.regions, mesh.on_surface, mesh.info,
          true,        faces,         mesh.mid_nodes, mesh.sets,    mesh.materials};
}

TEST(MeshView, PartsCellsByTheSetsTheyBelongTo) {
  const TetMesh mesh = testing::awkward_tets_with_sets();
  const std::vector<TetFace> faces = boundary_faces(mesh.tets);
  const MeshView view = view_of(mesh, faces);
  std::size_t triangles = 0;
  for (const Membership& part : triangles_by_sets(view)) {
    triangles += part.cells.size();
    for (std::size_t triangle : part.cells) {
      for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
        const auto& members = mesh.sets[s].faces;
        const bool in_set = std::find(members.begin(), members.end(), faces[triangle]) != members.end();
        EXPECT_EQ(in_set, std::find(part.sets.begin(), part.sets.end(), s) != part.sets.end());
      }
    }
  }
  EXPECT_EQ(triangles, faces.size());
  const std::vector<Membership> tets = tets_by_sets(view, {0, 1});
  ASSERT_EQ(tets.size(), 2u);
  EXPECT_EQ(tets[0].sets, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(tets[0].cells, (std::vector<std::size_t>{1}));
  EXPECT_EQ(tets[1].sets, (std::vector<std::size_t>{2}));
}

TEST(MeshView, MaterialsAreStatedInUnitsThatGoWithTheFiles) {
  TetMesh mesh = testing::awkward_tets();
  mesh.materials = {{"bone", 7, 17000, 0.3, 1900}};
  const MeshView view = view_of(mesh, {});
  EXPECT_EQ(view.region_name(7), "bone");
  EXPECT_EQ(view.region_name(2), "region_2");
  EXPECT_DOUBLE_EQ(view.modulus_in_unit(mesh.materials[0]), 17000);
  EXPECT_DOUBLE_EQ(view.density_in_unit(mesh.materials[0]), 1.9e-9);
  mesh.info.unit = LengthUnit::kMetre;
  EXPECT_DOUBLE_EQ(view.modulus_in_unit(mesh.materials[0]), 17e9);
  EXPECT_DOUBLE_EQ(view.density_in_unit(mesh.materials[0]), 1900);
}

}  // namespace
}  // namespace delvox::mesh_io
