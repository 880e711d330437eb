#include "delvox/core/density_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace delvox {
namespace {

TEST(DensityLaw, EveryLawHasANameASourceAndRises) {
  std::set<std::string> names;
  for (const DensityLaw& law : density_laws()) {
    EXPECT_TRUE(names.insert(law.name).second) << law.name;
    EXPECT_TRUE(law.source.find("19") != std::string::npos || law.source.find("20") != std::string::npos) << law.source;
    EXPECT_TRUE(law.density == "apparent" || law.density == "ash");
    double last = 0;
    for (double density = 0.02; density < 2; density += 0.01) {
      EXPECT_GT(law.modulus_mpa(density), 0.93 * last) << law.name << " at " << density;  // pieces need not meet
      last = law.modulus_mpa(density);
    }
    // Cortical bone, about 1.9 (apparent) or 1.1 (ash) g/cm3, is of the order of ten GPa.
    const double cortical = law.modulus_mpa(law.density == "ash" ? 1.1 : 1.9);
    EXPECT_GT(cortical, 5e3) << law.name;
    EXPECT_LT(cortical, 7e4) << law.name;
  }
}

TEST(DensityLaw, FiguresOfThePapersComeOut) {
  EXPECT_NEAR(find_density_law("morgan-femoral-neck")->modulus_mpa(0.5), 6850 * std::pow(0.5, 1.49), 1e-9);
  EXPECT_NEAR(find_density_law("keller")->modulus_mpa(1), 10500, 1e-9);
  EXPECT_NEAR(find_density_law("keyak")->modulus_mpa(0.2), 33900 * std::pow(0.2, 2.2), 1e-9);
  EXPECT_NEAR(find_density_law("keyak")->modulus_mpa(0.4), 5307 * 0.4 + 469, 1e-9);
  EXPECT_NEAR(find_density_law("keyak")->modulus_mpa(1), 10200, 1e-9);
}

TEST(DensityLaw, AUserMaySpellOne) {
  const auto law = find_density_law("E = 2000 * rho^1.5");
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->modulus_mpa(4), 16000, 1e-9);
  for (const char* text : {"", "keyak2", "E=", "E=2*rho", "E=2*rho^", "E=-2*rho^1", "E=2*rho^2 + x", "E=nan*rho^1"}) {
    EXPECT_FALSE(find_density_law(text)) << text;
  }
}

}  // namespace
}  // namespace delvox
