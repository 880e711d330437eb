// A handful of CGAL's sample surfaces; sample_surfaces_heavy_test.cpp takes them all.

#include "tools/sample_surfaces.h"

namespace delvox::test {
namespace {

TEST(SampleSurfaces, CleanClosedOnesAreMeshedRoundSharpPolygonalAndInsideOut) {
  TemporaryFolder folder;
  if (unpack_sample_surfaces(folder).empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  for (const char* name : {"elephant.off", "hand.off", "anchor.off", "tetrahedron.off", "star.off", "mpi.off", "sphere.stl"}) {
    expect_meshed(folder.path() / "data/meshes" / name, folder, {});
  }
}

TEST(SampleSurfaces, SharpEdgesOfMachinePartsAreKept) {
  TemporaryFolder folder;
  if (unpack_sample_surfaces(folder).empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  for (const char* name : {"fandisk.off", "joint.off", "rotor.off", "anchor_dense.off", "cross.off", "part.off"}) {
    expect_meshed(folder.path() / "data/meshes" / name, folder, {"--feature-angle", "60"});
  }
}

TEST(SampleSurfaces, OpenPinchedAndCrossingOnesAreRefused) {
  TemporaryFolder folder;
  if (unpack_sample_surfaces(folder).empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  for (const char* name : {"open_cube.off", "pig.stl", "cow.off", "elk.off"}) {
    expect_refused(folder.path() / "data/meshes" / name, folder);
  }
}

}  // namespace
}  // namespace delvox::test
