#include "core/take_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace delvox {
namespace {

struct Walk {
  std::size_t number;
  std::size_t steps;
};

class TakeTurns : public testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(Counts, TakeTurns, testing::Values(0, 1, 7, 8, 9, 100));

// Walk n takes n % 13 steps before it ends; every fifth has nothing to walk.
TEST_P(TakeTurns, EveryWalkIsWalkedToItsEndOnce) {
  std::vector<int> begun(GetParam(), 0), ended(GetParam(), 0);
  std::vector<std::size_t> steps(GetParam(), 0);
  const auto start = [&](std::size_t n) -> std::optional<Walk> {
    ++begun[n];
    return n % 5 == 0 ? std::nullopt : std::optional(Walk{n, n % 13});
  };
  const auto step = [&](Walk& walk) {
    if (walk.steps == 0) {
      ++ended[walk.number];
      return false;
    }
    --walk.steps;
    ++steps[walk.number];
    return true;
  };
  take_turns(GetParam(), start, step);
  for (std::size_t n = 0; n < GetParam(); ++n) {
    EXPECT_EQ(begun[n], 1);
    EXPECT_EQ(ended[n], n % 5 == 0 ? 0 : 1);
    EXPECT_EQ(steps[n], n % 5 == 0 ? 0 : n % 13);
  }
}

TEST(TakeTurnsOrder, OthersGoOnBetweenTwoStepsOfOne) {
  std::vector<std::size_t> walked;
  const auto start = [](std::size_t n) { return std::optional(Walk{n, 3}); };
  const auto step = [&](Walk& walk) {
    walked.push_back(walk.number);
    return walk.steps-- > 0;
  };
  take_turns(4, start, step);
  ASSERT_EQ(walked.size(), 16u);
  EXPECT_TRUE(std::equal(walked.begin(), walked.begin() + 8, std::vector<std::size_t>{0, 1, 2, 3, 0, 1, 2, 3}.begin()));
}

}  // namespace
}  // namespace delvox
