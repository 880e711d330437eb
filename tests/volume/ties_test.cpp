#include "delvox/volume/ties.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace delvox {
namespace {

TEST(Ties, CountsSamplesThatEqualTheIsovalueAndLabelsAllAlikeAtTheUntiedOne) {
  const std::vector<float> samples{0, 1, 2, 2, 3, 1, 0, 5};
  for (const bool below : {false, true}) {
    for (const double isovalue : {1.0, 2.0, 3.0, 1.5}) {
      Ties ties({isovalue, below});
      ties.add(samples.data(), 3);  // in pieces
      ties.add(samples.data() + 3, samples.size() - 3);
      EXPECT_EQ(ties.count(), static_cast<std::size_t>(std::count(samples.begin(), samples.end(), float(isovalue))));
      Ties again({ties.untied(), below});
      again.add(samples.data(), samples.size());
      EXPECT_EQ(again.count(), 0u);
      for (float s : samples) {
        EXPECT_EQ(below ? s <= isovalue : s >= isovalue, below ? s <= ties.untied() : s >= ties.untied());
      }
    }
  }
}

TEST(Ties, WithNothingOutsideThereIsNoOtherIsovalue) {
  const std::vector<float> samples{2, 2, 3};
  Ties ties({2, false});
  ties.add(samples.data(), samples.size());
  EXPECT_EQ(ties.untied(), 2);
}

}  // namespace
}  // namespace delvox
