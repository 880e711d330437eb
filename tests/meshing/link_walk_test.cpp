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

// Links along the axes that lie in the planes of facets, run along edges and meet vertices.
TEST(LinkWalkOnLattice, StaysOnTheLinkWhateverItTouches) {
  const auto oracle = test::unit_ball();
  RestrictedDelaunay delaunay(*oracle);
  std::vector<Point3> points;
  for (int i = 0; i < 6 * 6 * 6; ++i) {
    points.push_back(0.25 * Point3{i % 6 - 2.4, i / 6 % 6 - 2.4, i / 36 - 2.4});
  }
  delaunay.insert_seeds(points);
  test::Random random(9);
  std::size_t steps = 0, ended = 0;
  for (int n = 0; n < 600; ++n) {
    const auto place = [&] { return 0.125 * random.below(11) - 0.6; };  // on lattice planes, and halfway
    const int axis = n % 3;
    Point3 a{place(), place(), place()}, b = a;
    a[axis] = -0.55;
    b[axis] = 0.5 + 0.01 * (n % 7);
    const CellId last = delaunay.locate(b, delaunay.some_cell());
    LinkWalk walk(delaunay, a, b, delaunay.locate(a, last));
    while (walk.cell() != last) {
      if (const auto middle = walk.middle()) {
        ASSERT_TRUE(is_finite(*middle));
        ASSERT_GE((*middle)[axis], a[axis]);
        ASSERT_LE((*middle)[axis], b[axis]);
        for (int i = 0; i < 4; ++i) {
          const auto v = delaunay.vertices(FacetId{walk.cell(), i});
          if (*std::min_element(v.begin(), v.end()) < Delaunay3::kCorners) continue;
          const Point3& p = delaunay.point(v[0]);
          const Vector3 outward = cross(delaunay.point(v[1]) - p, delaunay.point(v[2]) - p);
          ASSERT_LE(dot(outward, *middle - p), 1e-12);
        }
      }
      if (!walk.next() || ++steps > 100000) break;
    }
    ended += walk.cell() == last;
  }
  EXPECT_GT(steps, 2000u);
  EXPECT_GT(ended, 200u);
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
