#include "oracle/surface_zeros.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/frame.h"
#include "delvox/core/errors.h"
#include "delvox/oracle/formula.h"
#include "support/random.h"
#include "support/smooth_formulas.h"

namespace delvox {
namespace {

using test::kBox, test::kSphere, test::kTorus, test::kTwoSheets;

/// A formula with its cover.
struct Covered {
  explicit Covered(const std::string& text, const Box3& box = kBox)
      : function(make_smooth_function(Formula(text))), cover(*function, box) {}
  std::unique_ptr<SmoothFunction> function;
  SurfaceCover cover;
};

std::string refusal(const std::string& text) {
  try {
    const Covered covered(text);
    return "";
  } catch (const OptionError& error) {
    return error.what();
  }
}

/// The region |coordinates| <= half.
ConvexRegion cube(double half) {
  ConvexRegion region;
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 normal;
    normal[axis] = 1;
    region.push_back({normal, half});
    region.push_back({-1.0 * normal, half});
  }
  return region;
}

PlanePart plane(const Point3& origin, const Vector3& normal) {
  PlanePart part{origin, {}, {}, cube(1.9), {Interval(-5, 5), Interval(-5, 5)}};
  find_frame((1 / norm(normal)) * normal, part.u, part.v);
  const double offset = dot(part.normal(), origin);
  part.region.push_back({part.normal(), offset + 1e-9});
  part.region.push_back({-1.0 * part.normal(), -offset + 1e-9});
  return part;
}

TEST(SurfaceCover, HoldsTheWholeSurface) {
  const Covered torus(kTorus);
  test::Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const double u = random.between(0, 2 * std::numbers::pi), v = random.between(0, 2 * std::numbers::pi);
    const Point3 p{(1 + 0.3 * std::cos(v)) * std::cos(u), (1 + 0.3 * std::cos(v)) * std::sin(u), 0.3 * std::sin(v)};
    const auto pieces = torus.cover.crossed_pieces(p, p + 1e-3 * random.direction());
    ASSERT_FALSE(pieces.empty());
    EXPECT_EQ(pieces[0].low, 0);
  }
}

TEST(SurfaceCover, RefusesWhatIsNotSmoothAndSaysWhere) {
  EXPECT_NE(refusal("max(abs(x),abs(y),abs(z))-1").find("kink"), std::string::npos);
  EXPECT_NE(refusal("max(x^2+y^2+z^2-1,x)").find("kink"), std::string::npos);
  EXPECT_NE(refusal("sqrt(x^2+y^2)+z^2-1").find(", 1 it may meet a kink"), std::string::npos);
  // A cone's tip, two balls that touch, and a double sphere have points without a normal.
  EXPECT_NE(refusal("x^2+y^2-z^2+x^4+y^4+z^4").find("without a normal"), std::string::npos);
  EXPECT_NE(refusal("((x-0.5)^2+y^2+z^2-0.25)*((x+0.5)^2+y^2+z^2-0.25)").find("without a normal"), std::string::npos);
  EXPECT_NE(refusal("(x^2+y^2+z^2-1)^2").find("without a normal"), std::string::npos);
  EXPECT_NE(refusal("x^2+y^2+z^2-9").find("border of the box"), std::string::npos);
  EXPECT_NE(refusal("x").find("border of the box"), std::string::npos);
}

TEST(SurfaceCover, KinksAwayFromTheSurfaceDoNotMatter) {
  EXPECT_EQ(refusal("(sqrt(x^2+y^2)-1)^2+z^2-0.1"), "");
  EXPECT_EQ(refusal("min((x-0.7)^2+y^2+z^2-0.25,(x+0.7)^2+y^2+z^2-0.25)"), "");
  EXPECT_EQ(refusal("abs(x^2+y^2+z^2-1)-0.1"), "");
}

TEST(SurfaceCover, KnowsThatThereIsNoSurface) {
  EXPECT_TRUE(Covered("x^2+y^2+z^2+0.01").cover.empty());
  EXPECT_FALSE(Covered(kSphere).cover.empty());
}

TEST(SurfaceZeros, LinesCrossAsOftenAsTheyDo) {
  const Covered sheets(kTwoSheets);
  test::Random random(2);
  int most = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Point3 a = random.in(kBox), b = random.in(kBox);
    std::size_t expected = 0;
    for (double radius : {1.0, 1.2}) {  // |a + t (b - a)|^2 = r^2
      const Vector3 ab = b - a;
      const double p = dot(a, ab) / squared_norm(ab), q = (squared_norm(a) - radius * radius) / squared_norm(ab);
      if (p * p <= q) continue;
      for (double t : {-p - std::sqrt(p * p - q), -p + std::sqrt(p * p - q)}) expected += t >= 0 && t <= 1;
    }
    const FoundPoints found = find_crossings(sheets.cover, a, b);
    EXPECT_EQ(found.points.size(), expected);
    EXPECT_TRUE(found.undecided.empty());
    most = std::max(most, static_cast<int>(expected));
    for (std::size_t i = 1; i < found.points.size(); ++i) {
      EXPECT_LT(distance(a, found.points[i - 1]), distance(a, found.points[i]));
    }
  }
  EXPECT_EQ(most, 4);
}

TEST(SurfaceZeros, ALineThatTouchesIsUndecided) {
  const Covered sphere(kSphere);
  const FoundPoints found = find_crossings(sphere.cover, {-1.5, 1, 0}, {1.3, 1, 0});
  EXPECT_TRUE(found.points.empty());
  ASSERT_FALSE(found.undecided.empty());
  for (const Point3& p : found.undecided) EXPECT_NEAR(norm(p - Point3{0, 1, 0}), 0, 1e-3);
}

TEST(SurfaceZeros, CriticalPointsOfASphereAndATorusAreTwoAndFour) {
  const Vector3 d = (1 / norm(Vector3{1, 2, 3})) * Vector3{1, 2, 3};
  const Covered sphere(kSphere), torus(kTorus);
  const FoundPoints poles = find_critical_points(sphere.cover, d);
  ASSERT_EQ(poles.points.size(), 2u);
  EXPECT_TRUE(poles.undecided.empty());
  for (const Point3& p : poles.points) EXPECT_NEAR(std::abs(dot(p, d)), 1, 1e-12);
  const FoundPoints found = find_critical_points(torus.cover, d);
  ASSERT_EQ(found.points.size(), 4u);
  EXPECT_TRUE(found.undecided.empty());
  for (const Point3& p : found.points) {  // p - its nearest point of the core circle is parallel to d
    const double r = std::hypot(p.x, p.y);
    const Vector3 normal = p - Point3{p.x / r, p.y / r, 0};
    EXPECT_NEAR(std::abs(dot(normal, d)), 0.3, 1e-9);
  }
}

TEST(SurfaceZeros, CurvesInAPlaneHaveTheirCriticalPoints) {
  Covered torus(kTorus);
  const PlanePart part = plane({0, 0, 0}, {0, 1, 0});  // two circles of radius 0.3 around (+-1, 0, 0)
  const Vector3 along{1, 0, 0};                        // critical in direction z
  const auto found = find_critical_points(torus.cover, part, along,
                                          torus.cover.critical_boxes(part.region, along, {0, 0, 0}, 0.1, 1000), 100);
  EXPECT_TRUE(found.undecided.empty());
  ASSERT_EQ(found.points.size(), 4u);
  for (const Point3& p : found.points) {
    EXPECT_NEAR(std::abs(p.x), 1, 1e-9);
    EXPECT_NEAR(std::abs(p.z), 0.3, 1e-9);
    EXPECT_NEAR(p.y, 0, 1e-12);
  }
}

TEST(SurfaceZeros, APlaneThatTouchesIsUndecidedThere) {
  Covered sphere(kSphere);
  const PlanePart part = plane({0, 0, 1}, {0, 0, 1});
  const Vector3 along{0.6, 0.8, 0};
  const auto found = find_critical_points(sphere.cover, part, along,
                                          sphere.cover.critical_boxes(part.region, along, {0, 0, 0}, 0.1, 1000), 100);
  EXPECT_TRUE(found.points.empty());
  ASSERT_FALSE(found.undecided.empty());
  for (const Point3& p : found.undecided) EXPECT_NEAR(distance(p, {0, 0, 1}), 0, 1e-2);
}

TEST(SurfaceZeros, SilhouettesMeetPlanesAndHaveCriticalPoints) {
  // The silhouette of a sphere in direction d is its great circle across d.
  Covered sphere(kSphere);
  const Vector3 d = (1 / norm(Vector3{1, -2, 2})) * Vector3{1, -2, 2}, d_prime = (1 / std::sqrt(2)) * Vector3{0, 1, 1};
  const auto boxes = sphere.cover.critical_boxes(cube(1.9), d, {0, 0, 0}, 0.1, 10000);
  const FoundPoints ends = find_silhouette_critical_points(sphere.cover, cube(1.9), d, d_prime, boxes, 100);
  EXPECT_TRUE(ends.undecided.empty());
  ASSERT_EQ(ends.points.size(), 2u);
  for (const Point3& p : ends.points) EXPECT_NEAR(distance(p, (dot(p, d_prime) > 0 ? 1.0 : -1.0) * d_prime), 0, 1e-9);

  const PlanePart part = plane({0, 0, 0.2}, {0.1, 0.2, 1});
  const FoundPoints met = find_critical_points(sphere.cover, part, d, boxes, 100);
  EXPECT_TRUE(met.undecided.empty());
  ASSERT_EQ(met.points.size(), 2u);
  for (const Point3& p : met.points) {
    EXPECT_NEAR(norm(p), 1, 1e-9);
    EXPECT_NEAR(dot(p, d), 0, 1e-9);
    EXPECT_NEAR(dot(part.normal(), p - part.origin), 0, 1e-9);
  }
}

}  // namespace
}  // namespace delvox
