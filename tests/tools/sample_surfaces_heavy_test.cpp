// Every one of CGAL's sample surfaces, at the default size and at half of it.

#include <algorithm>

#include "tools/sample_surfaces.h"

namespace delvox::test {
namespace {

// Open, not manifold or crossing themselves, as `delvox check` finds too; equal points being one.
const std::vector<std::string> kFaulty{
    "ALSTOM_TEST4.off", "ChineseDragon-10kv.off", "b9_mesh.off", "blade.off", "blob.off", "blobby_3cc.off",
    "bones.off", "bull.off", "camel.off", "corner_tris_with_hole.off", "corner_with_hole.off", "cow.off",
    "cube-ouvert.off", "cylinder.off", "cylinder_locally_refined.off", "degtri_sliding.off", "diplodocus.off",
    "double-torus-3-holes.off", "elephant-with-holes.off", "elk.off", "fold.off", "head.off", "hedra_open.off",
    "holes.off", "horizons.off", "in.off", "lion-head.off", "lion.off", "man.off", "mannequin-devil.off",
    "mask_cone.off", "mech-holes-shark.off", "mesh_with_border.off", "mesh_with_colors.off", "mushroom.off",
    "nefertiti.off", "negative.off", "open_cube.off", "patch-01.off", "patch-13.off", "patch-20.off", "patch-21.off",
    "patch-23.off", "patch-30.off", "pig.off", "pig.stl", "plane.off", "poly2x^2+y^2-0.062500.off",
    "polygon_mesh.off", "quad.off", "quads_to_stitch.off", "tetra_intersected_by_triangle.off", "three_peaks.off",
    "triangle.off", "triangular_hole.off"};
const std::string kPointsOnly = "b9.ply";

std::string half_of_default_size(const fs::path& surface) {
  Box3 box;
  const MeshFile file = read_mesh(surface);
  for (const Point3& p : std::get<SurfaceMesh>(file.mesh).points) box.extend(p);
  return std::to_string(box.diagonal() / 120);
}

TEST(AllSampleSurfaces, EveryCleanClosedOneIsMeshedAndEachOtherRefused) {
  TemporaryFolder folder;
  const std::vector<fs::path> surfaces = unpack_sample_surfaces(folder);
  if (surfaces.empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  std::size_t meshed = 0, refused = 0;
  for (const fs::path& surface : surfaces) {
    const std::string name = surface.filename().string();
    if (std::find(kFaulty.begin(), kFaulty.end(), name) != kFaulty.end()) {
      expect_refused(surface, folder);
      ++refused;
    } else if (name == kPointsOnly) {
      EXPECT_EQ(run_delvox({"remesh", surface.string(), "-o", folder / "out.vtu", "--quiet"}).code, 3);
    } else {
      expect_meshed(surface, folder, {});
      expect_meshed(surface, folder, {"--size", half_of_default_size(surface)});
      ++meshed;
    }
  }
  EXPECT_EQ(meshed, 87u);
  EXPECT_EQ(refused, kFaulty.size());
}

}  // namespace
}  // namespace delvox::test
