#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delvox/oracle/implicit_oracle.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "support/shapes.h"

namespace delvox {
namespace {

struct Sums {
  double inside_mm3 = 0, area_mm2 = 0;
  Vector3 up, down;
  std::size_t patches = 0;
  bool within_boxes = true;
};

Sums sums_of(const Oracle& oracle) {
  Sums sums;
  oracle.for_each_patch([&](const DomainPatch& patch) {
    sums.inside_mm3 += patch.inside_mm3;
    sums.area_mm2 += norm(patch.area_up + patch.area_down);
    sums.up = sums.up + patch.area_up;
    sums.down = sums.down + patch.area_down;
    ++sums.patches;
    const double box_mm3 = patch.width * patch.width * patch.width;
    sums.within_boxes &=
        patch.width > 0 && patch.inside_mm3 <= box_mm3 * (1 + 1e-9) && oracle.bounds().contains(patch.center);
  });
  return sums;
}

TEST(DomainPatches, AddUpToTheKnownVolumesAndAreasWhateverTheGrid) {
  PhantomOptions flat = test::cubic_image(48);
  flat.spacing = {1, 0.7, 1.6};
  for (const char* kind : {"sphere", "torus", "shells", "ellipsoid", "oblique-sphere"}) {
    for (const PhantomOptions& image : {phantom_defaults(kind), flat, test::oblique_image()}) {
      const PhantomTruth truth = phantom_truth(kind, image);
      const auto oracle = make_isosurface_oracle(make_phantom(kind, image), {truth.isovalue, false});
      const Sums sums = sums_of(*oracle);
      SCOPED_TRACE(kind);
      EXPECT_GT(sums.patches, 8u);
      EXPECT_TRUE(sums.within_boxes);
      if (truth.volume_mm3) {
        EXPECT_NEAR(sums.inside_mm3 / *truth.volume_mm3, 1, 0.03);
      }
      if (truth.area_mm2) {
        EXPECT_NEAR(sums.area_mm2 / *truth.area_mm2, 1, 0.08);
      }
      // What a closed surface shows to one side it shows to the other.
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(sums.up[axis], sums.down[axis], 1e-9 * sums.area_mm2);
    }
  }
}

TEST(DomainPatches, FormulasHaveThemToo) {
  ImplicitFunction ball;
  ball.value = [](const Point3& p) { return norm(p - Point3{}) - 10; };
  ball.gradient = [](const Point3& p) { return (1 / norm(p - Point3{})) * (p - Point3{}); };
  ball.box = {{-12, -12, -12}, {12, 12, 12}};
  ball.resolution = 0.5;
  const Sums sums = sums_of(*make_implicit_oracle(ball));
  EXPECT_NEAR(sums.inside_mm3, 4188.8, 0.03 * 4188.8);
  EXPECT_NEAR(sums.area_mm2, 1256.6, 0.05 * 1256.6);
}

}  // namespace
}  // namespace delvox
