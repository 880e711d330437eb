#include "delaunay/circumsphere.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace delvox {
namespace {

using ExactKernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using ExactPoint = ExactKernel::Point_3;

ExactPoint exact(const Point3& p) {
  return {p.x, p.y, p.z};
}
bool coplanar(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return CGAL::coplanar(exact(a), exact(b), exact(c), exact(d));
}

/// Relative to the radius: the distance from the true centre, and the error of the radius.
void expect_accurate(const Point3& a, const Point3& b, const Point3& c, const Point3& d, double rounding = 0) {
  ASSERT_FALSE(coplanar(a, b, c, d));
  const Circumsphere sphere = circumsphere(a, b, c, d);
  const ExactPoint center = CGAL::circumcenter(exact(a), exact(b), exact(c), exact(d));
  const double squared_radius = CGAL::to_double(CGAL::squared_distance(center, exact(a)));
  const double squared_error = CGAL::to_double(CGAL::squared_distance(center, exact(sphere.center)));
  EXPECT_LE(std::sqrt(squared_error), 1e-9 * std::sqrt(squared_radius) + rounding);
  EXPECT_NEAR(sphere.squared_radius / squared_radius, 1, 1e-9);
}

const Box3 kBox{{-1, -1, -1}, {1, 1, 1}};

TEST(Circumsphere, IsAccurateOnRandomTets) {
  test::Random random(1);
  for (int n = 0; n < 1000; ++n) {
    expect_accurate(random.in(kBox), random.in(kBox), random.in(kBox), random.in(kBox));
  }
}

TEST(Circumsphere, IsAccurateOnSlivers) {
  test::Random random(2);
  for (int n = 0; n < 1000; ++n) {
    // Four points near a circle's equator, off its plane by 1e-16 to 1.
    const double height = std::pow(10, -16 * random.unit());
    std::array<Point3, 4> p;
    for (int i = 0; i < 4; ++i) {
      const double angle = 1.5707 * i + 0.3 * random.unit();
      p[i] = {std::cos(angle), std::sin(angle), height * random.between(-1, 1)};
    }
    if (!coplanar(p[0], p[1], p[2], p[3])) expect_accurate(p[0], p[1], p[2], p[3]);
  }
}

TEST(Circumsphere, IsAccurateOnNeedlesAndWedges) {
  test::Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const double thin = std::pow(10, -12 * random.unit());
    const Point3 a = random.in(kBox), b = random.in(kBox);
    expect_accurate(a, a + thin * random.direction(), b, b + thin * random.direction());
    expect_accurate(a, a + thin * random.direction(), a + thin * random.direction(), b);
  }
}

TEST(Circumsphere, IsAccurateWithCornersFarAway) {
  test::Random random(4);
  for (int n = 0; n < 500; ++n) {
    const Point3 far = 1e3 * random.direction();
    expect_accurate(random.in(kBox), random.in(kBox), random.in(kBox), far);
    expect_accurate(random.in(kBox), random.in(kBox), far, 1e6 * random.direction());
  }
}

TEST(Circumsphere, FarFromTheOriginLosesOnlyTheRoundingOfCoordinates) {
  test::Random random(5);
  const Point3 shift{3e5, -7e5, 2e5};
  for (int n = 0; n < 500; ++n) {
    std::array<Point3, 4> p;
    for (Point3& q : p) q = shift + random.in(kBox);
    expect_accurate(p[0], p[1], p[2], p[3], 1e-9);
  }
}

TEST(Circumsphere, IsExactForTheUnitCorner) {
  const Circumsphere sphere = circumsphere({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2});
  EXPECT_EQ(sphere.center, (Point3{1, 1, 1}));
  EXPECT_EQ(sphere.squared_radius, 3);
}

}  // namespace
}  // namespace delvox
