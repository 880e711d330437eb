#include "delvox/oracle/jet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/oracle/formula.h"
#include "support/random.h"

namespace delvox {
namespace {

/// The same function as code and as a formula.
struct Pair {
  std::unique_ptr<SmoothFunction> code;
  const char* formula;
};

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  all.push_back({make_smooth_function_of([](const auto& x, const auto& y, const auto& z) {
                   return x * x + power(y, 3) - z / (2.0 + x * y) - 1.0;
                 }),
                 "x*x+y^3-z/(2+x*y)-1"});
  all.push_back({make_smooth_function_of([](const auto& x, const auto& y, const auto& z) {
                   return sin(x * y) * cos(z - x) + exp(-x * z) - sqrt(2.0 + x + y * y);
                 }),
                 "sin(x*y)*cos(z-x)+exp(-x*z)-sqrt(2+x+y^2)"});
  all.push_back({make_smooth_function_of([](const auto& x, const auto& y, const auto& z) {
                   return log(3.0 + x * y * z) * tanh(x - y) + power(2.0 + z, -2);
                 }),
                 "log(3+x*y*z)*tanh(x-y)+(2+z)^(-2)"});
  return all;
}

TEST(Jet, DerivativesAreThoseOfTheSameFormula) {
  test::Random random(1);
  for (const Pair& pair : pairs()) {
    const auto formula = make_smooth_function(Formula(pair.formula));
    for (int trial = 0; trial < 50; ++trial) {
      const Point3 p = random.in({{-1, -1, -1}, {1, 1, 1}});
      for (int order = 0; order <= 3; ++order) {
        double found[20], expected[20];
        pair.code->evaluate(p, order, found);
        formula->evaluate(p, order, expected);
        for (std::size_t i = 0; i < SmoothFunction::kResults[order]; ++i) {
          EXPECT_NEAR(found[i], expected[i], 1e-12 * (1 + std::abs(expected[i]))) << pair.formula << ", result " << i;
        }
      }
    }
  }
}

TEST(Jet, EnclosuresHoldWhatIsInABox) {
  test::Random random(2);
  for (const Pair& pair : pairs()) {
    for (int trial = 0; trial < 50; ++trial) {
      const Point3 p = random.in({{-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9}});
      const double width = std::pow(10, random.between(-6, -1));
      const IntervalBox box{{{p.x - width, p.x + width}, {p.y - width, p.y + width}, {p.z - width, p.z + width}}};
      Interval enclosures[20];
      ASSERT_TRUE(pair.code->enclose(box, 3, enclosures));
      for (int sample = 0; sample < 10; ++sample) {
        double values[20];
        pair.code->evaluate(p + width * random.direction(), 3, values);
        for (std::size_t i = 0; i < 20; ++i) EXPECT_TRUE(enclosures[i].contains(values[i])) << pair.formula << " " << i;
      }
    }
  }
}

TEST(Jet, WhereItIsNotSmoothIsTold) {
  const auto root = make_smooth_function_of(
      [](const auto& x, const auto& y, const auto& z) { return sqrt(x * x + y * y) + z * z - 1.0; });
  const IntervalBox on_axis{{{-0.1, 0.1}, {-0.1, 0.1}, {0, 1}}}, off_axis{{{0.1, 0.2}, {0.1, 0.2}, {0, 1}}};
  Interval results[20];
  EXPECT_FALSE(root->enclose(on_axis, 2, results));
  EXPECT_TRUE(root->enclose(off_axis, 2, results));
}

}  // namespace
}  // namespace delvox
