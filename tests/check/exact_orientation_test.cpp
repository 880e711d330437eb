#include "check/exact_orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "delvox/check/check_mesh.h"

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

TEST(ExactCircumradius, OfTetsOfAnyFlatnessIsThatOfTheSphereTheyWereMadeOn) {
  // Four points near a circle of radius 5, lifted off its plane by powers of two: on a sphere through it, whose radius
  // follows from the lift.
  for (int power = 0; power <= 40; ++power) {
    const double lift = std::ldexp(1.0, -power);
    const Point3 a{3, 4, 0}, b{-4, 3, 0}, c{-3, -4, 0}, d{4, -3, lift};
    // The centre is (0, 0, z) with 25 + z^2 = 25 + (lift - z)^2.
    EXPECT_NEAR(exact_circumradius(a, b, c, d), std::sqrt(25 + lift * lift / 4), 1e-14 * 5);
  }
  EXPECT_NEAR(exact_circumradius({0, 0, 0}, {1e-150, 0, 0}, {0, 1e-150, 0}, {0, 0, 1e-150}), std::sqrt(0.75) * 1e-150,
              1e-164);
  EXPECT_EQ(exact_circumradius({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}), Box3::kInfinity);
}

TEST(ExactCircumradius, ALatticeSliverIsNotTakenForALargeTet) {
  // Found in a mesh of CGAL's blob-closed.off: nearly a square, its six volumes are 2e-17, its radius 0.1656.
  const TetMesh mesh{{{0.7579412328465575, -0.2933925162578253, 0.44008435019464676},
                      {0.6097930846984093, -0.44154066440597345, 0.588232498342795},
                      {0.6097930846984093, -0.5896888125541216, 0.44008435019464676},
                      {0.7579412328465575, -0.44154066440597345, 0.29193620204649867}},
                     {{0, 1, 2, 3}},
                     {}, {}, {}, {}, {}, {}, {}, {}};
  CheckOptions options;
  options.bounds = Promises{};
  options.bounds->cell_size = 0.1657;
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_EQ(report.find("cell size")->status, CheckStatus::kPassed);
  EXPECT_NEAR(report.find("cell size")->measured, 0.16563466499998444, 1e-12);
}

}  // namespace
}  // namespace delvox::check
