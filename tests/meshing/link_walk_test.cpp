#include "meshing/link_walk.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

constexpr double kHalfWidth = 0.8;

class LinkWalkTest : public testing::Test {
 protected:
  LinkWalkTest() {
    std::vector<Point3> points;
    for (int n = 0; n < 3000; ++n) points.push_back(random_.in(kBox));
    delaunay_.insert_seeds(points);
  }

  const Box3 kBox{{-kHalfWidth, -kHalfWidth, -kHalfWidth}, {kHalfWidth, kHalfWidth, kHalfWidth}};
  test::Random random_{7};
  std::unique_ptr<SmoothOracle> oracle_ = test::unit_ball();
  RestrictedDelaunay delaunay_{*oracle_};
};

TEST_F(LinkWalkTest, MeetsTheCellsOfTheSegmentInOrder) {
  std::size_t steps = 0;
  for (int n = 0; n < 500; ++n) {
    const Point3 a = random_.in(kBox);
    Point3 b = random_.in(kBox);
    if (n % 2 == 0) b = a + Vector3{b.x - a.x, 0, 0};  // along an axis, as links mostly are
    const CellId last = delaunay_.locate(b, delaunay_.some_cell());
    LinkWalk walk(delaunay_, a, b, delaunay_.locate(a, last));
    double come = 0;
    while (walk.cell() != last) {
      const auto middle = walk.middle();
      ASSERT_TRUE(middle);
      EXPECT_EQ(delaunay_.locate(*middle, delaunay_.some_cell()), walk.cell());
      EXPECT_GT(distance(a, *middle), come);
      come = distance(a, *middle);
      ASSERT_TRUE(walk.next());
      ++steps;
    }
    EXPECT_LT(come, distance(a, b));
  }
  EXPECT_GT(steps, 2000u);
}

TEST_F(LinkWalkTest, BeyondTheSegmentCellsHaveNothingOfIt) {
  const Point3 a{-0.5, 0.1, 0.2}, b{-0.3, 0.12, 0.17};
  const CellId last = delaunay_.locate(b, delaunay_.some_cell());
  LinkWalk walk(delaunay_, a, b, delaunay_.locate(a, last));
  while (walk.cell() != last) ASSERT_TRUE(walk.next());
  EXPECT_TRUE(walk.middle());
  for (int n = 0; n < 5; ++n) {
    ASSERT_TRUE(walk.next());
    EXPECT_FALSE(walk.middle());
  }
}

}  // namespace
}  // namespace delvox
