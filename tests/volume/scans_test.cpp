// The readers on real scans (not part of the project): the folder DELVOX_SCANS, default ../shared/data, and Debian's
// libcgal-demo samples in DELVOX_CGAL_IMAGES, default /tmp/cgaldata/data/images. What is expected was worked out by
// hand from the headers' bytes.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "delvox/volume/read_volume.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

class Scans : public ::testing::Test {
 protected:
  /// The scan, or nothing where there is none; the test is then skipped.
  std::optional<Volume> load(const std::string& name) {
    const char* folder = std::getenv("DELVOX_SCANS");
    return load_from(folder != nullptr ? folder : DELVOX_DEFAULT_SCANS, name);
  }
  std::optional<Volume> load_from(const fs::path& folder, const std::string& name) {
    if (!fs::exists(folder / name)) return std::nullopt;
    const auto start = std::chrono::steady_clock::now();
    Volume volume = read_volume(folder / name);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    std::cout << name << " read in " << elapsed.count() << " s\n";
    return volume;
  }
  static void expect_point(const Volume& volume, const Point3& index, const Point3& expected) {
    const Point3 actual = volume.header().index_to_world(index);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(actual[axis], expected[axis], 1e-4);
  }
};

#define SKIP_WITHOUT(volume) \
  if (!volume) GTEST_SKIP() << "skipped: no scans"

TEST_F(Scans, Spm152HasItsDimensionsSpacingAndScaledRange) {
  const auto volume = load("spm152.nii.gz");
  SKIP_WITHOUT(volume);
  EXPECT_EQ(volume->dims(), (std::array<int, 3>{207, 256, 215}));
  EXPECT_NEAR(volume->header().spacing().x, 0.7374631, 1e-6);
  EXPECT_EQ(volume->header().orientation(), "RAS");
  EXPECT_EQ(volume->header().frame, Frame::kRas);
  EXPECT_EQ(volume->min(), 0);
  EXPECT_NEAR(volume->max(), 250 * 0.3629564, 1e-3);
  expect_point(*volume, {0, 0, 0}, {-75.762535, -110.762535, -71.762535});
  expect_point(*volume, {206, 255, 214}, {206 * 0.73746312 - 75.762535, 255 * 0.73746312 - 110.762535,
                                          214 * 0.73746312 - 71.762535});
  EXPECT_TRUE(volume->header().warnings.empty());
}

TEST_F(Scans, TheTiltedHeadCtKeepsItsObliqueAxes) {
  const auto volume = load("CT_pitch.nii.gz");
  SKIP_WITHOUT(volume);
  EXPECT_EQ(volume->dims(), (std::array<int, 3>{175, 248, 58}));
  EXPECT_NEAR(volume->header().spacing().x, 0.8125, 1e-6);
  EXPECT_NEAR(volume->header().spacing().y, 0.8125, 1e-5);
  EXPECT_NEAR(volume->header().spacing().z, 2.39705, 1e-5);
  EXPECT_EQ(volume->header().orientation(), "RAS");
  // The quaternion (b = -0.1434926) is a turn about x by 2 asin(b); no disagreement with sform is warned of.
  const double angle = 2 * std::asin(-0.14349260926246643);
  const Vector3 y = volume->header().index_to_world.column(1), z = volume->header().index_to_world.column(2);
  EXPECT_NEAR(y.y, 0.8125 * std::cos(angle), 1e-5);
  EXPECT_NEAR(y.z, 0.8125 * std::sin(angle), 1e-5);
  EXPECT_NEAR(z.y, -2.3970494 * std::sin(angle), 1e-5);
  EXPECT_NEAR(z.z, 2.3970494 * std::cos(angle), 1e-5);
  expect_point(*volume, {174, 247, 57}, {174 * 0.8125 - 69.020760, 247 * 0.77904105 + 57 * 0.68079877 - 134.385605,
                                         -247 * 0.23076248 + 57 * 2.29833841 - 13.568821});
  EXPECT_EQ(volume->min(), 0);
  EXPECT_EQ(volume->max(), 255);
  EXPECT_TRUE(volume->header().warnings.empty());
}

TEST_F(Scans, TheOthersHaveTheDimensionsThatTheirReadmeStates) {
  const auto avm = load("CT_AVM.nii.gz");
  SKIP_WITHOUT(avm);
  EXPECT_EQ(avm->dims(), (std::array<int, 3>{256, 242, 154}));
  EXPECT_NEAR(avm->max(), 255 * 2.2086275, 1e-3);
  const auto iguana = load("Iguana.nii.gz");
  SKIP_WITHOUT(iguana);
  EXPECT_EQ(iguana->dims(), (std::array<int, 3>{210, 256, 179}));
  EXPECT_NEAR(iguana->header().spacing().z, 0.1018, 1e-6);
  const auto deep = load("PD25_subcortical_labels.nii.gz");
  SKIP_WITHOUT(deep);
  EXPECT_EQ(deep->dims(), (std::array<int, 3>{69, 64, 46}));
  EXPECT_EQ(deep->max(), 16);
  expect_point(*deep, {0, 0, 0}, {-34, -36, -18});
}

TEST_F(Scans, CgalsSkullAndLiverAreRead) {
  const char* folder = std::getenv("DELVOX_CGAL_IMAGES");
  const fs::path images = folder != nullptr ? folder : "/tmp/cgaldata/data/images";
  const auto skull = load_from(images, "skull_2.9.inr");
  SKIP_WITHOUT(skull);
  EXPECT_EQ(skull->dims(), (std::array<int, 3>{64, 64, 64}));
  EXPECT_NEAR(skull->header().spacing().z, 3.65079, 1e-9);
  const auto liver = load_from(images, "liver.inr.gz");
  SKIP_WITHOUT(liver);
  EXPECT_EQ(liver->dims(), (std::array<int, 3>{438, 353, 165}));
  EXPECT_EQ(liver->max(), 255);
  EXPECT_EQ(liver->header().orientation(), "+x+y+z");
}

}  // namespace
}  // namespace delvox
