#include "check/exact_orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace delvox::check {
namespace {

TEST(ExactOrientation, UnitTetIsPositiveAndItsMirrorImageNegative) {
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
}

TEST(ExactOrientation, SeesTheLastBitOfACoordinate) {
  const double one_up = std::nextafter(1e3, 2e3), one_down = std::nextafter(1e3, 0.0);
  const Point3 a{0.1, 0.2, 1e3}, b{0.7, 0.3, 1e3}, c{0.2, 0.9, 1e3};
  EXPECT_EQ(orientation(a, b, c, {0.4, 0.5, 1e3}), 0);
  EXPECT_EQ(orientation(a, b, c, {0.4, 0.5, one_up}), 1);
  EXPECT_EQ(orientation(a, b, c, {0.4, 0.5, one_down}), -1);
}

TEST(ExactOrientation, CoplanarPointsInAnObliquePlaneAreZero) {
  // x + y + z = 3 * 2^-20, with coordinates that no rounding touches but whose products round.
  const double u = std::ldexp(1.0, -20);
  const Point3 a{u, u, u}, b{1 + u, -1 + u, u}, c{u, 1 + u, -1 + u}, d{3 + u, -7 + u, 4 + u};
  EXPECT_EQ(orientation(a, b, c, d), 0);
}

TEST(ExactOrientation, NeitherUnderflowNorOverflowMisleadsIt) {
  const double tiny = 1e-200, huge = 1e200;
  EXPECT_EQ(orientation({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {huge, 0, 0}, {0, huge, 0}, {0, 0, -huge}), -1);
  EXPECT_EQ(orientation({0, 0, 0}, {std::numeric_limits<double>::denorm_min(), 0, 0}, {0, huge, 0}, {0, 0, 1}), 1);
}

TEST(ExactOrientation, PlanarSignFollowsTheChosenAxes) {
  EXPECT_EQ(planar_orientation({9, 0, 0}, {9, 1, 0}, {9, 0, 1}, 1, 2), 1);
  EXPECT_EQ(planar_orientation({9, 0, 0}, {9, 0, 1}, {9, 1, 0}, 1, 2), -1);
  EXPECT_EQ(planar_orientation({0, 0, 0}, {0, 1e-3, 1e-3}, {0, 3e-3, 3e-3}, 1, 2), 0);
}

}  // namespace
}  // namespace delvox::check
