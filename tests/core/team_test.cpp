#include "core/team.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace delvox {
namespace {

TEST(Team, DoesEachPieceOfWorkOnceThousandsOfTimes) {
  for (int threads : {1, 2, 4, 16}) {
    Team team(threads);
    std::vector<int> done(7, 0);
    for (int round = 1; round <= 3000; ++round) {
      team.for_each(done.size(), [&](std::size_t i) { ++done[i]; });
      ASSERT_EQ(done, std::vector<int>(7, round));
    }
    team.for_each(0, [](std::size_t) { FAIL(); });
  }
}

TEST(Team, ThrowsWhatWorkThrowsAndWorksOn) {
  Team team(2);
  for (int round = 0; round < 100; ++round) {
    EXPECT_THROW(team.for_each(5, [](std::size_t i) { if (i == 3) throw std::runtime_error("three"); }),
                 std::runtime_error);
    std::vector<int> done(5, 0);
    team.for_each(5, [&](std::size_t i) { done[i] = 1; });
    EXPECT_EQ(done, std::vector<int>(5, 1));
  }
}

}  // namespace
}  // namespace delvox
