#include "oracle/poisson_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"

namespace delvox {
namespace {

/// What the header promises, read literally.
std::vector<std::uint32_t> brute_force(const std::vector<SpacedPoint>& candidates) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    const bool refused = std::any_of(kept.begin(), kept.end(), [&](std::uint32_t k) {
      const double reach = std::min(candidates[i].spacing, candidates[k].spacing);
      return squared_distance(candidates[i].point, candidates[k].point) < reach * reach;
    });
    if (!refused) kept.push_back(i);
  }
  return kept;
}

TEST(PoissonThinning, EqualsBruteForceForOneSpacing) {
  test::Random random(1);
  std::vector<SpacedPoint> candidates;
  for (int n = 0; n < 4000; ++n) candidates.push_back({random.in({{-5, -7, -3}, {6, 4, 5}}), 0.8});
  const auto kept = thin_poisson(candidates);
  EXPECT_EQ(kept, brute_force(candidates));
  EXPECT_LT(kept.size(), candidates.size() / 2);
}

TEST(PoissonThinning, EqualsBruteForceForSpacingsOverManyOctaves) {
  test::Random random(2);
  std::vector<SpacedPoint> candidates;
  for (int n = 0; n < 4000; ++n) {
    candidates.push_back({random.in({{-1, -1, -1}, {1, 1, 1}}), 0.5 * std::exp2(-8 * random.unit())});
  }
  // Spacings that are the octaves' limits themselves.
  for (int n = 0; n < 200; ++n) candidates.push_back({random.in({{-1, -1, -1}, {1, 1, 1}}), std::ldexp(0.5, -n % 6)});
  EXPECT_EQ(thin_poisson(candidates), brute_force(candidates));
}

TEST(PoissonThinning, KeepsOneOfSeveralEqualPointsAndPointsExactlyAtTheSpacing) {
  const std::vector<SpacedPoint> candidates{{{0, 0, 0}, 1},   {{0, 0, 0}, 1},  {{1, 0, 0}, 1},
                                            {{0.5, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{-1.5, 0, 0}, 0.5}};
  EXPECT_EQ(thin_poisson(candidates), (std::vector<std::uint32_t>{0, 2, 4, 5}));
}

TEST(PoissonThinning, OfNothingIsNothing) {
  EXPECT_TRUE(thin_poisson({}).empty());
}

TEST(PoissonThinning, WorksFarFromTheOrigin) {
  test::Random random(3);
  std::vector<SpacedPoint> candidates;
  const Box3 box{{1e6, -2e6, 3e6}, {1e6 + 3, -2e6 + 3, 3e6 + 3}};
  for (int n = 0; n < 2000; ++n) candidates.push_back({random.in(box), 0.3});
  EXPECT_EQ(thin_poisson(candidates), brute_force(candidates));
}

}  // namespace
}  // namespace delvox
