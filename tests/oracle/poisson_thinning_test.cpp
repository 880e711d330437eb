#include "oracle/poisson_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random.h"

namespace delvox {
namespace {

struct Candidate {
  Point3 point;
  double spacing;
};

std::vector<std::uint32_t> thin(const std::vector<Candidate>& candidates, double usual) {
  PoissonThinner thinner(usual);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    if (thinner.keep(candidates[i].point, candidates[i].spacing)) kept.push_back(i);
  }
  return kept;
}

/// What the header promises, read literally.
std::vector<std::uint32_t> brute_force(const std::vector<Candidate>& candidates) {
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
  std::vector<Candidate> candidates;
  for (int n = 0; n < 4000; ++n) candidates.push_back({random.in({{-5, -7, -3}, {6, 4, 5}}), 0.8});
  const auto kept = brute_force(candidates);
  EXPECT_LT(kept.size(), candidates.size() / 2);
  for (double usual : {0.8, 0.5, 0.1, 3.0}) EXPECT_EQ(thin(candidates, usual), kept) << usual;
}

TEST(PoissonThinning, EqualsBruteForceForSpacingsOverManyOctaves) {
  test::Random random(2);
  std::vector<Candidate> candidates;
  for (int n = 0; n < 4000; ++n) {
    candidates.push_back({random.in({{-1, -1, -1}, {1, 1, 1}}), 0.5 * std::exp2(-8 * random.unit())});
  }
  // Spacings that are the octaves' limits themselves.
  for (int n = 0; n < 200; ++n) candidates.push_back({random.in({{-1, -1, -1}, {1, 1, 1}}), std::ldexp(0.5, -n % 6)});
  for (double usual : {0.5, 0.07, 0.001}) EXPECT_EQ(thin(candidates, usual), brute_force(candidates)) << usual;
}

TEST(PoissonThinning, KeepsOneOfSeveralEqualPointsAndPointsExactlyAtTheSpacing) {
  const std::vector<Candidate> candidates{{{0, 0, 0}, 1},   {{0, 0, 0}, 1},  {{1, 0, 0}, 1},
                                          {{0.5, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{-1.5, 0, 0}, 0.5}};
  EXPECT_EQ(thin(candidates, 1), (std::vector<std::uint32_t>{0, 2, 4, 5}));
}

TEST(PoissonThinning, EqualsBruteForceForAStreamThatSweepsSpace) {
  test::Random random(4);
  std::vector<Candidate> candidates;
  for (int n = 0; n < 4000; ++n) {
    candidates.push_back({random.in({{-3, 0.001 * n, 0}, {3, 0.001 * n + 0.3, 0.1}}), 0.25});
  }
  EXPECT_EQ(thin(candidates, 0.25), brute_force(candidates));
}

TEST(PoissonThinning, WorksFarFromTheOrigin) {
  test::Random random(3);
  std::vector<Candidate> candidates;
  const Box3 box{{1e6, -2e6, 3e6}, {1e6 + 3, -2e6 + 3, 3e6 + 3}};
  for (int n = 0; n < 2000; ++n) candidates.push_back({random.in(box), 0.3});
  EXPECT_EQ(thin(candidates, 0.3), brute_force(candidates));
}

}  // namespace
}  // namespace delvox
