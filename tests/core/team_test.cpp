#include "core/team.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/parallel.h"

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

TEST(Team, GivesEachThreadNeighbouringPieces) {
  Team team(2);
  for (int round = 0; round < 100; ++round) {
    std::array<std::thread::id, 6> done_by;
    std::atomic<int> begun = 0;
    team.for_each(done_by.size(), [&](std::size_t i) {
      ++begun;
      while (begun < 2) std::this_thread::yield();  // one piece each, at least
      done_by[i] = std::this_thread::get_id();
    });
    EXPECT_EQ(done_by[0], std::this_thread::get_id());
    EXPECT_NE(done_by[3], std::this_thread::get_id());
  }
}

TEST(Team, IsAtHandForLoopsOfTheThreadThatMadeIt) {
  EXPECT_EQ(Team::at_hand(), nullptr);
  {
    Team team(2);
    const Team later(2);
    EXPECT_EQ(Team::at_hand(), &team);
    std::thread([] { EXPECT_EQ(Team::at_hand(), nullptr); }).join();
    std::vector<int> done(1000, 0);
    team.for_each(10, [&](std::size_t i) {
      EXPECT_EQ(Team::at_hand(), nullptr);  // it is at work
      for_each_chunk(100, 7, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) ++done[100 * i + n];
      });
    });
    EXPECT_EQ(done, std::vector<int>(1000, 1));
    EXPECT_EQ(Team::at_hand(), &team);
    EXPECT_THROW(for_each_chunk(9, 1, [](std::size_t, std::size_t) { throw std::runtime_error("any"); }),
                 std::runtime_error);
    EXPECT_EQ(Team::at_hand(), &team);
  }
  EXPECT_EQ(Team::at_hand(), nullptr);
}

}  // namespace
}  // namespace delvox
