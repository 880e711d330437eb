// The promises on the scans of the folder DELVOX_SCANS and, at larger sizes, on Debian's samples.

#include "volume_bars.h"

namespace delvox::test {
namespace {

class LargeSampleBars : public testing::TestWithParam<Scan> {};
class ScanBars : public testing::TestWithParam<Scan> {};
class ScanTopology : public testing::TestWithParam<Scan> {};

TEST_P(LargeSampleBars, EveryPromiseHoldsAndASecondRunGivesTheSameBytes) {
  TemporaryFolder folder;
  const std::string volume = unpack_sample(GetParam().file, folder);
  if (volume.empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  for (double size : GetParam().sizes) expect_promises_held(volume, GetParam().options, size, folder);
}

TEST_P(ScanBars, EveryPromiseHoldsAndASecondRunGivesTheSameBytes) {
  TemporaryFolder folder;
  const std::string volume = find_scan(GetParam().file);
  if (volume.empty()) GTEST_SKIP() << "skipped: no scans";
  for (double size : GetParam().sizes) expect_promises_held(volume, GetParam().options, size, folder);
}

TEST_P(ScanTopology, CropsAtHalfAVoxelHaveTheTopologyOfTheVoxels) {
  TemporaryFolder folder;
  const std::string volume = find_scan(GetParam().file);
  if (volume.empty()) GTEST_SKIP() << "skipped: no scans";
  expect_topology_of_the_voxels(GetParam(), volume, folder);
}

const Scan kSkull{"skull", "skull_2.9.inr", {"--iso", "2.9"}, {2.765, 1.81}};
const Scan kLiver{"liver", "liver.inr.gz", {"--iso", "64", "--smooth", "0.8"}, {3.09, 2.06}};
const std::vector<Scan> kScans = {
    {"spm152", "spm152.nii.gz", {"--iso", "40"}, {5.74, 3.03, 1.97},
     {"80:112,100:132,80:112", "100:132,60:92,100:132", "60:108,120:168,100:148"}, 0.3687},
    {"CT_pitch_bone", "CT_pitch.nii.gz", {"--iso", "175.5"}, {3.23, 1.77, 1.07}, {"60:92,200:232,20:52"}, 0.406},
    {"CT_pitch_skin", "CT_pitch.nii.gz", {"--iso", "35.5"}, {4.71, 2.62, 1.72}, {"20:52,100:132,10:42"}, 0.406},
    {"CT_AVM", "CT_AVM.nii.gz", {"--iso", "180"}, {1.756, 0.971, 0.62}, {"110:158,110:158,60:108"}, 0.36},
    {"Iguana", "Iguana.nii.gz", {"--iso", "120"}, {0.36, 0.203, 0.134}, {"80:112,100:132,80:112"}, 0.0509},
};

INSTANTIATE_TEST_SUITE_P(Debian, LargeSampleBars, testing::Values(kSkull, kLiver), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Scans, ScanBars, testing::ValuesIn(kScans), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Scans, ScanTopology, testing::ValuesIn(kScans), testing::PrintToStringParamName());

}  // namespace
}  // namespace delvox::test
