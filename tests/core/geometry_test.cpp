#include "delvox/core/geometry.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace delvox {
namespace {

Affine3 random_affine(test::Random& random) {
  Affine3 affine;
  for (auto& row : affine.rows) {
    for (double& entry : row) entry = random.between(-2, 2);
  }
  for (int axis = 0; axis < 3; ++axis) affine.rows[axis][axis] += 5;  // diagonally dominant, so well away from singular
  return affine;
}

const Box3 kBox{{-10, -10, -10}, {10, 10, 10}};

TEST(Geometry, AnAffineAndItsInverseUndoEachOther) {
  test::Random random(1);
  for (int n = 0; n < 100; ++n) {
    const Affine3 affine = random_affine(random), inverse = affine.inverse();
    const Point3 p = random.in(kBox);
    EXPECT_LT(distance(inverse(affine(p)), p), 1e-12);
    EXPECT_LT(distance(affine(inverse(p)), p), 1e-12);
    EXPECT_NEAR(affine.determinant() * inverse.determinant(), 1, 1e-12);
  }
}

TEST(Geometry, TheInverseOfAReflectedScalingIsExact) {
  Affine3 affine;
  affine.rows = {{{-2, 0, 0, 3}, {0, 0, 4, -1}, {0, 0.5, 0, 8}}};
  Affine3 expected;
  expected.rows = {{{-0.5, 0, 0, 1.5}, {0, 0, 2, -16}, {0, 0.25, 0, 0.25}}};
  const Affine3 inverse = affine.inverse();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) EXPECT_EQ(inverse.rows[row][column], expected.rows[row][column]);
  }
}

TEST(Geometry, ComposeActsInnerFirst) {
  test::Random random(2);
  for (int n = 0; n < 100; ++n) {
    const Affine3 outer = random_affine(random), inner = random_affine(random);
    const Point3 p = random.in(kBox);
    EXPECT_LT(distance(compose(outer, inner)(p), outer(inner(p))), 1e-12 * 1e3);
    EXPECT_GT(distance(compose(inner, outer)(p), outer(inner(p))), 1e-6);
  }
}

TEST(Geometry, AVectorIsNotTranslatedAndItsTransposeIsTheAdjoint) {
  test::Random random(3);
  const Affine3 affine = random_affine(random);
  const Vector3 v = random.in(kBox), w = random.in(kBox);
  EXPECT_LT(distance(affine.linear(v), affine(v) - affine(Point3{})), 1e-12);
  EXPECT_NEAR(dot(affine.linear(v), w), dot(v, affine.linear_transposed(w)), 1e-10);
  EXPECT_EQ(affine.column(1), affine.linear({0, 1, 0}));
}

TEST(Geometry, ABoxStartsEmptyAndGrowsToHoldItsPoints) {
  Box3 box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diagonal(), 0);
  EXPECT_FALSE(box.contains({}));
  box.extend({1, 2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_TRUE(box.contains({1, 2, 3}));
  box.extend({-1, 5, 3});
  EXPECT_EQ(box.min, (Point3{-1, 2, 3}));
  EXPECT_EQ(box.max, (Point3{1, 5, 3}));
  EXPECT_EQ(box.center(), (Point3{0, 3.5, 3}));
  EXPECT_FALSE(box.contains({0, 3, 3.0001}));
}

}  // namespace
}  // namespace delvox
