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

bool is_faulty(const std::string& name) { return std::find(kFaulty.begin(), kFaulty.end(), name) != kFaulty.end(); }

/// One share of them, so that ctest may run the shares side by side.
constexpr std::size_t kShares = 8;
class AllSampleSurfaces : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Share, AllSampleSurfaces, testing::Range(std::size_t{0}, kShares));

TEST_P(AllSampleSurfaces, EveryCleanClosedOneIsMeshedAndEachOtherRefused) {
  TemporaryFolder folder;
  const std::vector<fs::path> surfaces = unpack_sample_surfaces(folder);
  if (surfaces.empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  for (std::size_t i = GetParam(); i < surfaces.size(); i += kShares) {
    const fs::path& surface = surfaces[i];
    const std::string name = surface.filename().string();
    if (is_faulty(name)) {
      expect_refused(surface, folder);
    } else if (name == kPointsOnly) {
      EXPECT_EQ(run_delvox({"remesh", surface.string(), "-o", folder / "out.vtu", "--quiet"}).code, 3);
    } else {
      expect_meshed(surface, folder, {});
      expect_meshed(surface, folder, {"--size", half_of_default_size(surface)});
    }
  }
}

TEST(AllSampleSurfacesTogether, Are87CleanClosedOnes) {
  TemporaryFolder folder;
  const std::vector<fs::path> surfaces = unpack_sample_surfaces(folder);
  if (surfaces.empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  const auto faulty = std::count_if(surfaces.begin(), surfaces.end(),
                                    [](const fs::path& surface) { return is_faulty(surface.filename().string()); });
  EXPECT_EQ(static_cast<std::size_t>(faulty), kFaulty.size());
  EXPECT_EQ(surfaces.size(), 87 + kFaulty.size() + 1);
}

}  // namespace
}  // namespace delvox::test
