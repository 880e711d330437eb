#include "oracle/formula_program.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oracle/formula_algebra.h"
#include "delvox/oracle/interval_functions.h"
#include "support/random.h"

namespace delvox {
namespace {

const char* const kSmoothFormulas[] = {"x^2+y^2+z^2-1",
                                       "(sqrt(x^2+y^2+0.1)-1)^2+z^2-0.1",
                                       "sin(3*x)*cos(2*y)+exp(-z^2)*x-0.3",
                                       "1/(1+x^2)+y/(2+z)-log(3+x*y)",
                                       "x^0.5*(2+z)^1.5+(2+x)^y-(1.5+y*x/4)^-2",
                                       "tanh(x*y)+sinh(z)-cosh(x/2)+atan(x-z)+asin(y/3)*acos(z/3)+tan(x/4)",
                                       "(x-y+z-0.7)^3*(x^2+y)*(z-x*y)"};
/// 0.1 or more away from where any of the formulas stops being smooth.
const Box3 kDomain{{0.1, -0.9, -0.9}, {0.9, 0.9, 0.9}};

/// Which of the results of one order less, derived along which axis, each derivative is.
struct Parent {
  std::size_t of;
  int axis;
};
constexpr Parent kParents[20] = {{0, 0}, {0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 2},
                                 {4, 0}, {4, 1}, {4, 2}, {5, 1}, {5, 2}, {6, 2}, {7, 1}, {7, 2}, {8, 2}, {9, 2}};

TEST(FormulaProgram, DerivativesAreThoseThatDifferencesShow) {
  test::Random random(1);
  for (const char* text : kSmoothFormulas) {
    const FormulaProgram program = compile_formula(parse_formula(text), 3);
    for (int trial = 0; trial < 20; ++trial) {
      const Point3 p = random.in(kDomain);
      double at_p[20];
      program.evaluate(p, 20, at_p);
      for (std::size_t i = 1; i < 20; ++i) {
        constexpr double kStep = 1e-5;
        double before[20], after[20];
        Vector3 step;
        step[kParents[i].axis] = kStep;
        program.evaluate(p - step, 10, before);
        program.evaluate(p + step, 10, after);
        const double slope = (after[kParents[i].of] - before[kParents[i].of]) / (2 * kStep);
        EXPECT_NEAR(at_p[i], slope, 1e-5 * (1 + std::abs(slope))) << text << ", derivative " << i;
      }
    }
  }
}

TEST(FormulaProgram, EnclosuresHoldAllValuesAndDerivatives) {
  test::Random random(2);
  for (const char* text : kSmoothFormulas) {
    const FormulaProgram program = compile_formula(parse_formula(text), 3);
    for (int trial = 0; trial < 200; ++trial) {
      const Point3 center = random.in(kDomain);
      const double width = std::pow(10, random.between(-8, -1));
      const IntervalBox box{{{center.x - width, center.x + width},
                             {center.y - width, center.y + width},
                             {center.z - width, center.z + width}}};
      Interval enclosures[20];
      program.enclose(box, 20, enclosures);
      for (int sample = 0; sample < 10; ++sample) {
        const Point3 p = random.in({{box[0].low, box[1].low, box[2].low}, {box[0].high, box[1].high, box[2].high}});
        double values[20];
        program.evaluate(p, 20, values);
        for (std::size_t i = 0; i < 20; ++i) {
          if (std::isnan(values[i])) continue;
          // What is evaluated has rounding errors of its own.
          const double noise = 1e-11 * (1 + std::abs(values[i]));
          EXPECT_LE(enclosures[i].low, values[i] + noise) << text << ", result " << i;
          EXPECT_GE(enclosures[i].high, values[i] - noise) << text << ", result " << i;
        }
      }
    }
  }
}

TEST(FormulaProgram, EnclosuresShrinkWithTheirBoxes) {
  test::Random random(3);
  for (const char* text : kSmoothFormulas) {
    const FormulaProgram program = compile_formula(parse_formula(text), 3);
    const Point3 p = random.in(kDomain);
    const double w = 1e-7;
    Interval enclosures[20];
    EXPECT_TRUE(program.enclose({{{p.x - w, p.x + w}, {p.y - w, p.y + w}, {p.z - w, p.z + w}}}, 20, enclosures))
        << text;
    for (const Interval& e : enclosures) EXPECT_LT(e.width(), 1e-3) << text;
  }
}

TEST(FormulaProgram, KinksPolesAndEdgesOfTheDomainAreNotSmooth) {
  const IntervalBox around_zero{{{-0.1, 0.1}, {0.2, 0.3}, {0.4, 0.5}}};
  const IntervalBox beside{{{0.09, 0.1}, {0.2, 0.3}, {0.4, 0.5}}};
  for (const char* text : {"abs(x)", "min(x,2*x)", "max(0.25,y+x)", "sqrt(x)", "x^0.3", "1/x", "x^-2", "log(x)",
                           "tan(x+pi/2)", "asin(1+x)", "acos(x-1)", "sqrt(x^2)"}) {
    const FormulaProgram program = compile_formula(parse_formula(text), 0);
    Interval enclosure;
    EXPECT_FALSE(program.enclose(around_zero, 1, &enclosure)) << text;
    if (text[0] == 'a' && text[1] != 'b') continue;  // asin and acos end on that side
    EXPECT_TRUE(program.enclose(beside, 1, &enclosure)) << text;
  }
}

TEST(FormulaProgram, EqualPartsAreComputedOnce) {
  const FormulaProgram once = compile_formula(parse_formula("exp(x*y)+z"), 0);
  const FormulaProgram twice = compile_formula(parse_formula("exp(x*y)+z*(sin(exp(y*x))+exp(x*y))"), 0);
  EXPECT_LE(twice.size(), once.size() + 3);
}

TEST(FormulaProgram, TheOrderOfTermsDoesNotChangeABit) {
  const FormulaProgram one = compile_formula(parse_formula("0.3*x+y*0.7-z+sin(x)*y*z"), 1);
  const FormulaProgram other = compile_formula(parse_formula("z*sin(x)*y-z+0.7*y+x*0.3"), 1);
  test::Random random(4);
  for (int trial = 0; trial < 1000; ++trial) {
    const Point3 p = random.in(kDomain);
    double a[4], b[4];
    one.evaluate(p, 4, a);
    other.evaluate(p, 4, b);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(a[i], b[i]);
  }
}

TEST(Interval, SineReachesItsExtremesWhereItShould) {
  EXPECT_EQ(sin(Interval(1, 2)).high, 1);
  EXPECT_LT(sin(Interval(1, 1.5)).high, 1);
  EXPECT_EQ(sin(Interval(-2, -1)).low, -1);
  EXPECT_EQ(cos(Interval(-0.1, 0.1)).high, 1);
  EXPECT_EQ(cos(Interval(3, 4)).low, -1);
  EXPECT_EQ(sin(Interval(0, 7)).low, -1);
}

TEST(Interval, ProductsAndQuotientsOfAllAreAll) {
  const Interval all = Interval::all(), zero = 0.0;
  EXPECT_EQ((all * zero).high, 0);
  EXPECT_FALSE((all * Interval(0, 1)).bounded());
  EXPECT_FALSE((all - all).bounded());
  EXPECT_FALSE((Interval(1) / Interval(-1, 1)).bounded());
  EXPECT_TRUE((Interval(1) / Interval(1e-3, 1)).bounded());
}

}  // namespace
}  // namespace delvox
