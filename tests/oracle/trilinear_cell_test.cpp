#include "oracle/trilinear_cell.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oracle/brick_field.h"
#include "support/random.h"

namespace delvox {
namespace {

Vector3 gradient(const std::array<float, 8>& s, const Point3& p) {
  const double step = 0.125;  // trilinear: central differences along an axis are exact
  return {(trilinear(s, p.x + step, p.y, p.z) - trilinear(s, p.x - step, p.y, p.z)) / (2 * step),
          (trilinear(s, p.x, p.y + step, p.z) - trilinear(s, p.x, p.y - step, p.z)) / (2 * step),
          (trilinear(s, p.x, p.y, p.z + step) - trilinear(s, p.x, p.y, p.z - step)) / (2 * step)};
}

/// Critical points by Newton's method from many starts.
std::vector<Point3> newton_saddles(const std::array<float, 8>& s) {
  std::vector<Point3> found;
  for (int start = 0; start < 64; ++start) {
    Point3 p{(start % 4 + 0.5) / 4, (start / 4 % 4 + 0.5) / 4, (start / 16 + 0.5) / 4};
    for (int i = 0; i < 60; ++i) {
      Affine3 hessian;
      hessian.rows = {};
      for (int axis = 0; axis < 3; ++axis) {
        Point3 ahead = p, behind = p;
        ahead[axis] += 0.5;
        behind[axis] -= 0.5;
        const Vector3 column = gradient(s, ahead) - gradient(s, behind);
        for (int row = 0; row < 3; ++row) hessian.rows[row][axis] = column[row];
      }
      if (hessian.determinant() == 0) break;
      p = p - hessian.inverse().linear(gradient(s, p));
    }
    const bool inside = p.x > 1e-6 && p.x < 1 - 1e-6 && p.y > 1e-6 && p.y < 1 - 1e-6 && p.z > 1e-6 && p.z < 1 - 1e-6;
    if (!is_finite(p) || !inside || norm(gradient(s, p)) > 1e-9) continue;
    bool known = false;
    for (const Point3& q : found) known |= distance(p, q) < 1e-6;
    if (!known) found.push_back(p);
  }
  return found;
}

TEST(TrilinearCell, BodySaddlesAreTheCriticalPointsThatNewtonFinds) {
  test::Random random(1);
  std::size_t total = 0;
  for (int n = 0; n < 400; ++n) {
    std::array<float, 8> s;
    for (float& value : s) value = static_cast<float>(random.between(-1, 1));
    const auto saddles = body_saddles(s);
    EXPECT_LE(saddles.size(), 2u);
    for (const Point3& p : saddles) EXPECT_LT(norm(gradient(s, p)), 1e-6);
    for (const Point3& p : newton_saddles(s)) {
      bool known = false;
      for (const Point3& q : saddles) known |= distance(p, q) < 1e-5;
      EXPECT_TRUE(known);
      ++total;
    }
  }
  EXPECT_GT(total, 30u);
}

TEST(TrilinearCell, BodySaddlesOfAFunctionWithoutTripleTermAreFoundToo) {
  // yz + zx + xy about (0.4, 0.6, 0.5).
  std::array<float, 8> s;
  for (int corner = 0; corner < 8; ++corner) {
    const double x = (corner & 1) - 0.4, y = (corner >> 1 & 1) - 0.6, z = (corner >> 2) - 0.5;
    s[corner] = static_cast<float>(y * z + z * x + x * y);
  }
  const auto saddles = body_saddles(s);
  ASSERT_EQ(saddles.size(), 1u);
  EXPECT_LT(distance(saddles[0], {0.4, 0.6, 0.5}), 1e-4);
}

TEST(TrilinearCell, LinearAndConstantCellsHaveNoSaddle) {
  EXPECT_TRUE(body_saddles({1, 1, 1, 1, 1, 1, 1, 1}).empty());
  EXPECT_TRUE(body_saddles({0, 1, 2, 3, 4, 5, 6, 7}).empty());
  EXPECT_FALSE(face_saddle(0, 1, 3, 2));
}

TEST(TrilinearCell, FaceSaddleIsWhereBothSlopesVanish) {
  test::Random random(2);
  int found = 0;
  for (int n = 0; n < 1000; ++n) {
    const double a = random.between(-1, 1), b = random.between(-1, 1), c = random.between(-1, 1),
                 d = random.between(-1, 1);
    const auto saddle = face_saddle(a, b, c, d);
    if (!saddle) continue;
    ++found;
    const auto [x, y] = *saddle;
    EXPECT_NEAR((b - a) * (1 - y) + (c - d) * y, 0, 1e-9);
    EXPECT_NEAR((d - a) * (1 - x) + (c - b) * x, 0, 1e-9);
  }
  EXPECT_GT(found, 100);
  const auto middle = face_saddle(1, -1, 1, -1);
  ASSERT_TRUE(middle);
  EXPECT_EQ((*middle)[0], 0.5);
}

std::array<float, 8> random_samples(test::Random& random) {
  std::array<float, 8> samples;
  for (float& sample : samples) sample = static_cast<float>(random.between(-1, 1));
  return samples;
}

TEST(Cubic, IsTheTrilinearFunctionAlongALine) {
  test::Random random(7);
  for (int n = 0; n < 1000; ++n) {
    const auto samples = random_samples(random);
    const Point3 p = random.in({{0, 0, 0}, {1, 1, 1}}), q = random.in({{0, 0, 0}, {1, 1, 1}});
    const double level = random.between(-1, 1);
    const Cubic cubic = cubic_along(samples, level, p, q - p);
    for (int step = 0; step <= 10; ++step) {
      const double t = step / 10.0;
      const Point3 u = p + t * (q - p);
      EXPECT_NEAR(cubic(t), trilinear(samples, u.x, u.y, u.z) - level, 1e-14);
      EXPECT_NEAR(cubic.slope(t), (cubic(t + 1e-6) - cubic(t - 1e-6)) / 2e-6, 1e-7);
    }
  }
}

TEST(Cubic, RootsAreFoundWhateverItsShape) {
  test::Random random(8);
  std::size_t roots = 0;
  for (int n = 0; n < 20000; ++n) {
    Cubic cubic;
    for (double& c : cubic.c) c = random.between(-1, 1) * std::pow(10.0, random.between(-6, 3));
    if (n % 4 == 0) {  // a triple root, or nearly one
      const double r = random.unit(), shift = n % 8 == 0 ? 0 : random.between(-1e-9, 1e-9);
      cubic.c = {-r * r * r + shift, 3 * r * r, -3 * r, 1};
    }
    const double low = 0.5 * random.unit(), high = random.between(low + 1e-9, 1);
    if ((cubic(low) > 0) == (cubic(high) > 0)) continue;
    ++roots;
    const double t = cubic.root_between(low, high);
    ASSERT_GE(t, low);
    ASSERT_LE(t, high);
    double scale = 0;
    for (double c : cubic.c) scale += std::abs(c);
    EXPECT_LE(std::abs(cubic(t)), 1e-14 * scale) << n;
  }
  EXPECT_GT(roots, 2000u);
}

TEST(Cubic, AnEndThatIsZeroIsARoot) {
  const Cubic rising{{0, 1, 0, 0}}, falling{{1, -1, 0, 0}};
  EXPECT_NEAR(rising.root_between(0, 1), 0, 1e-15);
  EXPECT_NEAR(falling.root_between(0, 1), 1, 1e-15);
}

}  // namespace
}  // namespace delvox
