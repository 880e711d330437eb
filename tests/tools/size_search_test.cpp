#include "size_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

namespace delvox::tools {
namespace {

std::size_t count(double tets) { return static_cast<std::size_t>(tets); }

TEST(FindSize, EndsWithinThreePercentOnACubeLaw) {
  const auto mesh_at = [](double size) { return count(1e6 / std::pow(size, 3)); };
  const SizeSearch found = find_size(50000, 10, mesh_at);
  EXPECT_EQ(found.end, SearchEnd::kFound);
  EXPECT_EQ(found.tets, mesh_at(found.size));
  EXPECT_NEAR(static_cast<double>(found.tets), 50000, 0.031 * 50000);
  EXPECT_LE(found.tries, 3);
}

TEST(FindSize, EndsWithinThreePercentWhereTheSurfaceDominates) {
  const auto mesh_at = [](double size) { return count(1e6 / std::pow(size, 3) + 4e5 / std::pow(size, 2)); };
  const SizeSearch found = find_size(50000, 10, mesh_at);
  EXPECT_EQ(found.end, SearchEnd::kFound);
  EXPECT_LE(found.tries, 5);
}

TEST(FindSize, EndsWithinThreePercentFromAnyFirstGuess) {
  for (double first : {0.1, 1.0, 3.0, 10.0, 100.0}) {
    const auto mesh_at = [](double size) { return count(1e6 / std::pow(size, 2.2)); };
    EXPECT_EQ(find_size(50000, first, mesh_at).end, SearchEnd::kFound) << first;
  }
}

// As where all components lie below the default of --min-component at the first size.
TEST(FindSize, NoTetsAtAllAreTooFewAndTheSizeGetsSmaller) {
  const auto mesh_at = [](double size) { return size > 2 ? 0 : count(1e6 / std::pow(size, 3)); };
  for (std::size_t wanted : {200000u, 1000000u, 5000000u}) {
    const SizeSearch found = find_size(wanted, 9, mesh_at);
    EXPECT_EQ(found.end, SearchEnd::kFound) << wanted;
    EXPECT_LE(found.size, 2);
  }
}

TEST(FindSize, BetweenTooManyAndTooFewItStaysBetween) {
  double low = 0, high = 1e9;
  const SizeSearch found = find_size(5000, 4, [&](double size) {
    EXPECT_GT(size, low);
    EXPECT_LT(size, high);
    const std::size_t tets = size > 3 ? 4000 : count(2e5 / std::pow(size, 3));
    (tets > 5000 ? low : high) = size;
    return tets;
  });
  EXPECT_TRUE(found.end == SearchEnd::kJump || found.end == SearchEnd::kOutOfTries);
  EXPECT_EQ(found.tets, 4000u);
}

// As a spongy component is at any size: its topology needs the vertices.
TEST(FindSize, AFloorIsSeenAfterTwoTries) {
  const auto mesh_at = [](double size) { return 700000 + count(2e4 / std::pow(size, 3)); };
  const SizeSearch found = find_size(20000, 1, mesh_at);
  EXPECT_EQ(found.end, SearchEnd::kFloor);
  EXPECT_EQ(found.tries, 2);
  EXPECT_NE(describe(found, 20000).find("no size gives 20,000 tets"), std::string::npos);
}

TEST(FindSize, CountsThatWaverStillEndNearTheWantedNumber) {
  const auto mesh_at = [](double size) {
    return count(5e5 / std::pow(size, 3) * (1 + 0.04 * std::sin(400 * size)));
  };
  for (double first : {1.5, 2.0, 2.5, 3.0, 3.5}) {
    const SizeSearch found = find_size(20000, first, mesh_at);
    EXPECT_NEAR(static_cast<double>(found.tets), 20000, 0.05 * 20000) << first;
  }
}

TEST(FindSize, EndsAfterEightTriesWhereThereIsNothingAtAnySize) {
  const SizeSearch found = find_size(5000, 4, [](double) { return std::size_t{0}; });
  EXPECT_EQ(found.tries, 8);
  EXPECT_EQ(found.tets, 0u);
}

TEST(FindSize, EndsAtOnceWhenALimitStoppedTheRun) {
  const SizeSearch found = find_size(5000, 4, [](double) -> std::optional<std::size_t> { return std::nullopt; });
  EXPECT_EQ(found.tries, 1);
  EXPECT_EQ(found.size, 4);
  EXPECT_EQ(found.end, SearchEnd::kStopped);
}

}  // namespace
}  // namespace delvox::tools
