#include "delvox/oracle/formula.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

const Box3 kBox{{-2, -2, -2}, {2, 2, 2}};

std::unique_ptr<SmoothOracle> oracle_of(const std::string& text, const Box3& box = kBox) {
  return make_formula_oracle(Formula(text), box, 0.05);
}

TEST(Formula, IsInsideWhereItIsAtMostZero) {
  const auto oracle = oracle_of("x^2+y^2+z^2-1");
  EXPECT_EQ(oracle->label({0, 0, 0.5}), 1);
  EXPECT_EQ(oracle->label({0, 0, 1}), 1);
  EXPECT_EQ(oracle->label({0, 1.5, 0}), 0);
  EXPECT_EQ(oracle->value({0, 0, 0}), 1);
  EXPECT_EQ(oracle->gradient({0.5, 0, 0}), (Vector3{-1, 0, 0}));
}

TEST(Formula, SeedsAndCrossingsLieOnTheSurface) {
  const auto oracle = oracle_of("(sqrt(x^2+y^2)-1)^2+z^2-0.1");
  const Seeds seeds = oracle->seeds(0.2);
  EXPECT_EQ(seeds.components, 1u);
  EXPECT_GT(seeds.points.size(), 50u);
  for (const Point3& p : seeds.points) EXPECT_NEAR(oracle->value(p), 0, 1e-13);
  const auto crossings = oracle->intersect_all({-1.9, 0.01, 0.02}, {1.9, 0.03, 0.01});
  ASSERT_EQ(crossings.size(), 4u);
  for (const Point3& p : crossings) EXPECT_NEAR(oracle->value(p), 0, 1e-13);
}

TEST(Formula, ADomainThatReachesTheBoxIsRefused) {
  EXPECT_THROW(oracle_of("x^2+y^2+z^2-5"), OptionError);
  EXPECT_THROW(oracle_of("1-x^2-y^2-z^2"), OptionError);
  EXPECT_THROW(oracle_of("x^2+y^2-1"), OptionError);
  // A bump of a hundredth of the box's width, off every grid.
  EXPECT_THROW(oracle_of("min(x^2+y^2+z^2-1, (x-2.0)^2+(y-0.731)^2+(z+0.337)^2-0.0004)"), OptionError);
  EXPECT_NO_THROW(oracle_of("max(x^2+y^2-1, abs(z)-1.99)"));
}

TEST(Formula, WhatIsUndefinedIsOutside) {
  const auto oracle = oracle_of("max(sqrt(x)-1, x^2+y^2+z^2-1)");
  EXPECT_EQ(oracle->label({-0.1, 0, 0}), 0);
  EXPECT_EQ(oracle->label({0.1, 0, 0}), 1);
}

TEST(Formula, RefusesWhatIsNoRealFunction) {
  for (const char* text : {"sqrt(-1)*x", "x+log(-2)", "1/0+x", "x+(0-8)^0.5", "asin(2)*x", "x+0^-1", "exp(1e9)*x"}) {
    EXPECT_THROW(Formula{text}, OptionError) << text;
  }
}

TEST(Formula, RefusesBoxesThatMakeNoSense) {
  EXPECT_THROW(oracle_of("x^2+y^2+z^2-1", {{1, 1, 1}, {-1, 2, 2}}), OptionError);
  EXPECT_THROW(make_formula_oracle(Formula("x^2+y^2+z^2-1"), kBox, 0), OptionError);
  EXPECT_THROW(oracle_of("x^2+y^2+z^2+1"), NothingToMesh);
}

}  // namespace
}  // namespace delvox
