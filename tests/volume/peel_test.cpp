#include "delvox/volume/peel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace delvox {
namespace {

VolumeHeader header_of(int n) {
  VolumeHeader header;
  header.dims = {n, n, n};
  return header;
}

/// A cube of 1000 from `from` to `to` (inclusive) along each axis, with a rim of 400, in 0.
Volume rimmed_cube(int n, int from, int to) {
  std::vector<float> samples;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int low = std::min({i, j, k}), high = std::max({i, j, k});
        const bool in = low >= from && high <= to, core = low > from && high < to;
        samples.push_back(core ? 1000.0f : in ? 400.0f : 0.0f);
      }
    }
  }
  return {header_of(n), samples};
}

TEST(Peel, GivesTheRimAndWhatIsBeyondTheValueOfTheCore) {
  const Volume volume = rimmed_cube(15, 4, 10);
  const Volume peeled_volume = peeled(volume, {200, false}, 1);
  for (int i = 4; i <= 10; ++i) EXPECT_EQ(peeled_volume.value(i, 7, 4), 1000) << i;
  EXPECT_EQ(peeled_volume.value(7, 7, 3), 1000);
  EXPECT_EQ(peeled_volume.value(7, 7, 1), 1000) << "three voxels beyond";
  EXPECT_EQ(peeled_volume.value(7, 7, 0), 0);
  EXPECT_EQ(peeled_volume.value(7, 7, 7), 1000);
}

TEST(Peel, WhereThereIsNoCoreNothingChanges) {
  const Volume volume = rimmed_cube(9, 3, 4);
  const Volume peeled_volume = peeled(volume, {200, false}, 2);
  EXPECT_EQ(peeled_volume.samples(), volume.samples());
}

TEST(Peel, InsideMayBeBelow) {
  std::vector<float> samples = rimmed_cube(15, 4, 10).samples();
  for (float& sample : samples) sample = -sample;
  const Volume peeled_volume = peeled({header_of(15), samples}, {-200, true}, 1);
  EXPECT_EQ(peeled_volume.value(4, 7, 7), -1000);
}

}  // namespace
}  // namespace delvox
