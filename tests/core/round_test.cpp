#include "core/round.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace delvox {
namespace {

TEST(Round, IsFloorAndCeil) {
  test::Random random(1);
  for (int n = 0; n < 100000; ++n) {
    const double scale = std::ldexp(1.0, random.below(60) - 8);
    double x = random.between(-scale, scale);
    if (n % 3 == 0) x = std::round(x);
    ASSERT_EQ(static_cast<double>(floor_to_int(x)), std::floor(x)) << x;
    ASSERT_EQ(static_cast<double>(ceil_to_int(x)), std::ceil(x)) << x;
  }
  EXPECT_EQ(floor_to_int(-0.0), 0);
  EXPECT_EQ(ceil_to_int(-0.5), 0);
}

}  // namespace
}  // namespace delvox
