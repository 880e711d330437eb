#include "delvox/oracle/implicit_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "delvox/core/errors.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

ImplicitFunction ball(double radius, const Point3& center = {}) {
  ImplicitFunction function;
  function.value = [=](const Point3& p) { return distance(p, center) - radius; };
  function.gradient = [=](const Point3& p) { return (1 / distance(p, center)) * (p - center); };
  function.box = {{-10, -10, -10}, {10, 10, 10}};
  function.resolution = 0.5;
  return function;
}

TEST(ImplicitOracle, TurnsTheSignRoundSoThatInsideIsPositive) {
  const auto oracle = make_implicit_oracle(ball(4));
  EXPECT_EQ(oracle->value({1, 0, 0}), 3);
  EXPECT_EQ(oracle->value({6, 0, 0}), -2);
  EXPECT_EQ(oracle->gradient({6, 0, 0}), (Vector3{-1, 0, 0}));
  EXPECT_EQ(oracle->label({1, 0, 0}), 1);
  EXPECT_EQ(oracle->label({6, 0, 0}), 0);
}

TEST(ImplicitOracle, RefusesWhatMakesNoSense) {
  for (double resolution : {0.0, -1.0, std::nan("")}) {
    ImplicitFunction function = ball(4);
    function.resolution = resolution;
    EXPECT_THROW(make_implicit_oracle(function), OptionError) << resolution;
  }
  ImplicitFunction function = ball(4);
  function.box = Box3{};
  EXPECT_THROW(make_implicit_oracle(function), OptionError);
  function.box = {{1, 1, 1}, {-1, 2, 2}};
  EXPECT_THROW(make_implicit_oracle(function), OptionError);
}

TEST(ImplicitOracle, SaysWhenThereIsNothingToMesh) {
  EXPECT_THROW(make_implicit_oracle(ball(100)), NothingToMesh);
  EXPECT_THROW(make_implicit_oracle(ball(1, {50, 0, 0})), NothingToMesh);
}

TEST(ImplicitOracle, SeedsLieOnSmallComponentsToo) {
  // Two balls, one of them only three grid steps wide, off the grid's samples.
  const Point3 small{6.13, -5.29, 4.77};
  ImplicitFunction function = ball(3);
  function.value = [=](const Point3& p) { return std::min(norm(p) - 3, distance(p, small) - 0.8); };
  function.gradient = [=](const Point3& p) {
    return norm(p) - 3 < distance(p, small) - 0.8 ? (1 / norm(p)) * p : (1 / distance(p, small)) * (p - small);
  };
  const auto oracle = make_implicit_oracle(function);
  const Seeds seeds = oracle->seeds(2.0);
  EXPECT_EQ(seeds.components, 2u);
  int on_small = 0;
  for (const Point3& p : seeds.points) {
    EXPECT_NEAR(oracle->value(p), 0, 1e-12);
    on_small += std::abs(distance(p, small) - 0.8) < 1e-9;
  }
  EXPECT_GE(on_small, 4);
}

}  // namespace
}  // namespace delvox
