#include "oracle/formula_syntax.h"

#include <gtest/gtest.h>

#include <numbers>

#include "delvox/core/errors.h"
#include "delvox/oracle/formula.h"

namespace delvox {
namespace {

double value_of(const std::string& text) {
  return Formula(text).value({2, 3, 5});
}

TEST(FormulaSyntax, BindsAsInMathematics) {
  EXPECT_EQ(value_of("x+y*z"), 17);
  EXPECT_EQ(value_of("(x+y)*z"), 25);
  EXPECT_EQ(value_of("x-y-z"), -6);
  EXPECT_EQ(value_of("x/y*6/4"), 1);
  EXPECT_EQ(value_of("-x^2"), -4);
  EXPECT_EQ(value_of("(-x)^2"), 4);
  EXPECT_EQ(value_of("x^y^2"), 512);
  EXPECT_EQ(value_of("4*x^-1"), 2);
  EXPECT_EQ(value_of("- -x + +y"), 5);
  EXPECT_EQ(value_of(" x\t*\ny "), 6);
}

TEST(FormulaSyntax, KnowsNumbersConstantsAndFunctions) {
  EXPECT_EQ(value_of(".5e1*x + 1e-1*0"), 10);
  EXPECT_DOUBLE_EQ(value_of("cos(pi)+log(e)+x"), 2);
  EXPECT_EQ(value_of("min(x,y,z)+max(x,y,z)"), 7);
  EXPECT_DOUBLE_EQ(value_of("sqrt(x+2)+abs(x-y)+exp(0*x)"), 4);
  EXPECT_DOUBLE_EQ(value_of("asin(x/4)+acos(x/4)"), std::numbers::pi / 2);
  EXPECT_NEAR(value_of("tan(atan(x))+cosh(y)^2-sinh(y)^2+tanh(0*z)"), 3, 1e-12);
}

TEST(FormulaSyntax, NamesThePlaceOfWhatDoesNotParse) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "position 1, its end"}, {"x+", "position 3"},       {"(x", "position 3"},        {"x)", "position 2, ')'"},
      {"2 x", "position 3, 'x'"},  {"x==1", "position 2"},     {"x*foo(y)", "position 3"},  {"w", "unknown name 'w'"},
      {"sin x", "position 5"},     {"sin(x,y)", "position 1"}, {"x+min(x)", "position 3"},  {"x**2", "position 3"},
      {"1e999*x", "position 1"},   {"x,y", "position 2"},      {"x\xc3\xa9", "position 2"}, {"3..5", "position 3"}};
  for (const auto& [text, words] : cases) {
    try {
      parse_formula(text);
      ADD_FAILURE() << text << " parses";
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << text << ": " << error.what();
    }
  }
}

TEST(FormulaSyntax, RefusesNestingThatWouldExhaustTheStack) {
  EXPECT_THROW(parse_formula(std::string(90000, '(')), OptionError);
  EXPECT_THROW(parse_formula(std::string(90000, '-') + "x"), OptionError);
  std::string tower = "x";
  for (int i = 0; i < 20000; ++i) tower += "^x";
  EXPECT_THROW(parse_formula(tower), OptionError);
  EXPECT_THROW(parse_formula(std::string(200000, ' ') + "x"), OptionError);
}

TEST(FormulaSyntax, TakesLongSums) {
  std::string sum = "x";
  for (int i = 0; i < 5000; ++i) sum += "+y";
  EXPECT_EQ(value_of(sum), 15002);
}

}  // namespace
}  // namespace delvox
