// intersect_all of formulas: certified by intervals, so that no step is too wide for what lies between.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "delvox/oracle/formula.h"
#include "support/random.h"

namespace delvox {
namespace {

const Box3 kBox{{-2, -2, -2}, {2, 2, 2}};
constexpr double kResolution = 0.1;  // what steps of a quarter of it cannot see is looked for here

std::unique_ptr<SmoothOracle> oracle_of(const std::string& text) {
  return make_formula_oracle(Formula(text), kBox, kResolution);
}

TEST(FormulaCrossings, ALineThatAllButTouchesASphereCrossesItTwice) {
  const auto sphere = oracle_of("x^2+y^2+z^2-1");
  for (double depth : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const double y = 1 - depth;
    const auto crossings = sphere->intersect_all({-1.7, y, 0}, {1.9, y, 0});
    ASSERT_EQ(crossings.size(), 2u) << depth;
    const double half = std::sqrt(depth * (2 - depth));
    EXPECT_NEAR(crossings[0].x, -half, 1e-6 * half + 1e-15 / half);
    EXPECT_NEAR(crossings[1].x, half, 1e-6 * half + 1e-15 / half);
  }
  EXPECT_EQ(sphere->intersect_all({-1.7, 1 + 1e-9, 0}, {1.9, 1 + 1e-9, 0}).size(), 0u);
  EXPECT_EQ(sphere->intersect_all({-1.7, 1, 0}, {1.9, 1, 0}).size() % 2, 0u);
}

TEST(FormulaCrossings, NoneIsMissedHoweverDenseTheyAre) {
  // Sheets a hundredth apart within a ball.
  const auto sheets = oracle_of("max(sin(314.15926535897931*x), x^2+y^2+z^2-1)");
  const auto crossings = sheets->intersect_all({-0.5049, 0.1, 0.2}, {0.5051, 0.1, 0.2});
  ASSERT_EQ(crossings.size(), 101u);  // at every hundredth from -0.50 to 0.50
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    EXPECT_NEAR(crossings[i].x, (static_cast<double>(i) - 50) / 100, 1e-12);
  }
}

TEST(FormulaCrossings, LabelsAgreeWithTheirNumberAllAlongRandomLines) {
  const auto oracle = oracle_of("sin(9*x)*cos(8*y)+sin(9*y)*cos(8*z)+sin(7*z)*cos(8*x)+3*(x^2+y^2+z^2)-3");
  test::Random random(1);
  std::size_t found = 0;
  for (int line = 0; line < 300; ++line) {
    const Point3 a = random.in(kBox), b = random.in(kBox);
    const auto crossings = oracle->intersect_all(a, b);
    found += crossings.size();
    Label label = oracle->label(a);
    Point3 last = a;
    for (const Point3& p : crossings) {
      EXPECT_GE(squared_distance(p, a), squared_distance(last, a));
      EXPECT_NEAR(oracle->value(p), 0, 1e-12);
      if (distance(last, p) > 1e-9) {
        EXPECT_EQ(oracle->label(midpoint(last, p)), label);
      }
      last = p;
      label = 1 - label;
    }
    EXPECT_EQ(oracle->label(b), label);
  }
  EXPECT_GT(found, 300u);
}

TEST(FormulaCrossings, WhereTheFormulaIsUndefinedFlatOrBeyondTheBoxTheyEndSoon) {
  const auto half = oracle_of("max(sqrt(x)-1, x^2+y^2+z^2-1)");
  EXPECT_EQ(half->intersect_all({-1.9, 0.1, 0}, {1.9, 0.1, 0}).size(), 2u);
  const auto flat = oracle_of("max(abs(x)-1,0)+max(abs(y)-1,0)+max(abs(z)-1,0)");  // 0 in all of a cube
  EXPECT_EQ(flat->intersect_all({-1.9, 0.13, 0.2}, {1.9, 0.14, 0.1}).size(), 2u);
  const auto sphere = oracle_of("x^2+y^2+z^2-1");
  EXPECT_EQ(sphere->intersect_all({-1e6, 0.1, 0}, {1e6, 0.1, 0}).size(), 2u);
  EXPECT_EQ(sphere->intersect_all({-1e6, 3, 0}, {1e6, 3, 0}).size(), 0u);
  EXPECT_EQ(sphere->intersect_all({0, 0, 0}, {0, 0, 0}).size(), 0u);
}

}  // namespace
}  // namespace delvox
