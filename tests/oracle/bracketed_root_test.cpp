#include "oracle/bracketed_root.h"

#include <gtest/gtest.h>

#include <functional>

namespace delvox {
namespace {

struct Case {
  std::function<double(double)> f;
  double root;
  double tolerance;
};

double solve(const std::function<double(double)>& f, double a, double b, int* calls = nullptr) {
  int count = 0;
  const auto counted = [&](double t) {
    ++count;
    return f(t);
  };
  const double root = bracketed_root(counted, a, f(a), b, f(b), 1.0);
  if (calls != nullptr) *calls = count;
  return root;
}

TEST(BracketedRoot, FindsRootsOfTameAndNastyFunctionsFromEitherEnd) {
  const std::vector<Case> cases{
      {[](double t) { return t - 0.3; }, 0.3, 1e-15},
      {[](double t) { return 0.3 - t; }, 0.3, 1e-15},
      {[](double t) { return std::cos(t) - t; }, 0.7390851332151607, 1e-15},
      {[](double t) { return std::exp(30 * t) - std::exp(6.0); }, 0.2, 1e-14},
      {[](double t) { return std::cbrt(t - 0.25); }, 0.25, 1e-15},
      {[](double t) { return 1e-12 * (t - 0.6); }, 0.6, 1e-3},     // flat: down to rounding noise of scale 1 at once
      {[](double t) { return std::pow(t - 0.4, 5); }, 0.4, 2e-3},  // |f| <= noise
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_NEAR(solve(cases[i].f, 0, 1), cases[i].root, cases[i].tolerance) << i;
    EXPECT_NEAR(solve(cases[i].f, 1, 0), cases[i].root, cases[i].tolerance) << i;
  }
}

TEST(BracketedRoot, ReturnsAnEndThatIsARoot) {
  EXPECT_EQ(solve([](double t) { return -t; }, 0, 1), 0);
  EXPECT_EQ(solve([](double t) { return 1 - t; }, 0, 1), 1);
}

// Weights halved at every step, not only at the second in a row, once cost 48 calls instead of 7.
TEST(BracketedRoot, NeedsFewCallsForACubic) {
  int total = 0;
  for (int n = 1; n < 100; ++n) {
    const double root = n / 100.0;
    const auto cubic = [&](double t) { return (t - root) * (t * t + 0.1); };
    int calls = 0;
    const double found = solve(cubic, 0, 1, &calls);
    EXPECT_NEAR(found, root, 1e-14);
    total += calls;
  }
  EXPECT_LT(total, 99 * 20);
}

TEST(BracketedRoot, SurvivesEndValuesThatOnlyTellTheSide) {
  // Bricks that are all inside know their label only, and give a huge number for a value.
  const auto f = [](double t) { return t - 0.3; };
  EXPECT_NEAR(bracketed_root(f, 0.0, -1e30, 1.0, 0.7, 1.0), 0.3, 1e-14);
  EXPECT_NEAR(bracketed_root(f, 0.0, -0.3, 1.0, 1e30, 1.0), 0.3, 1e-14);
}

}  // namespace
}  // namespace delvox
