#include "meshing/repair_effort.h"

#include <gtest/gtest.h>

#include <cmath>

namespace delvox {
namespace {

/// Counts insertions octave by octave from radius 1 down, `first` in the first and `growth` times as many in each next,
/// into a mesh that begins with `vertices`; returns how many there were once repair was hopeless, or 0 if it never was.
std::size_t insertions_until_hopeless(double first, double growth, std::size_t vertices) {
  RepairEffort effort(1);
  std::size_t insertions = 0;
  for (int octave = 0; octave < 12; ++octave) {
    const double radius = std::exp2(-octave - 0.5), count = first * std::pow(growth, octave);
    for (int n = 0; n < count; ++n) {
      effort.add(radius, vertices + ++insertions);
      if (effort.hopeless()) return insertions;
    }
  }
  return 0;
}

TEST(RepairEffort, IsHopelessSoonWhereEachHalvingTakesAMultiple) {
  for (double growth : {2.0, 4.0}) {
    const std::size_t insertions = insertions_until_hopeless(1000, growth, 10000);
    EXPECT_GT(insertions, 0u);
    EXPECT_LT(static_cast<double>(insertions), 1000 * 4 * std::pow(growth, 3));
  }
}

TEST(RepairEffort, IsNeverHopelessWhereFinerNecksAreRarer) {
  for (double growth : {0.2, 0.7, 1.0}) EXPECT_EQ(insertions_until_hopeless(5000, growth, 10000), 0u);
}

TEST(RepairEffort, AFewRodsAreFollowedUntilTheyAreAShareOfTheMesh) {
  const std::size_t insertions = insertions_until_hopeless(10, 2, 100000);
  EXPECT_GT(insertions, 1000u);
  EXPECT_LT(insertions, 5000u);
  EXPECT_EQ(insertions_until_hopeless(10, 2, 10000000), 0u);
}

TEST(RepairEffort, BallsAboveTheWidestDoNotCount) {
  RepairEffort effort(1), never(0);
  for (int n = 0; n < 100000; ++n) {
    effort.add(std::exp2(16 - std::log2(n + 1)), 1000);
    never.add(1.0 / (n + 1), 1000);
  }
  EXPECT_FALSE(effort.hopeless());
  EXPECT_FALSE(never.hopeless());
}

}  // namespace
}  // namespace delvox
