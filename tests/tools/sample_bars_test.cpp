// The promises on Debian's sample volumes (package libcgal-demo), at sizes that take seconds.

#include "volume_bars.h"

namespace delvox::test {
namespace {

class SampleBars : public testing::TestWithParam<Scan> {};

TEST_P(SampleBars, EveryPromiseHoldsAndASecondRunGivesTheSameBytes) {
  TemporaryFolder folder;
  const std::string volume = unpack_sample(GetParam().file, folder);
  if (volume.empty()) GTEST_SKIP() << "skipped: libcgal-demo is not installed";
  for (const Aim& aim : GetParam().aims) expect_promises_held(volume, GetParam().options, aim, folder);
}

const Scan kSkull{"skull", "skull_2.9.inr", {"--iso", "2.9"}, {{4.92, 50'000}}};
const Scan kLiver{"liver", "liver.inr.gz", {"--iso", "64", "--smooth", "0.8"}, {{5.4, 50'000}, {2.5, 126'000, 0.3}}};

INSTANTIATE_TEST_SUITE_P(Debian, SampleBars, testing::Values(kSkull, kLiver), testing::PrintToStringParamName());

}  // namespace
}  // namespace delvox::test
