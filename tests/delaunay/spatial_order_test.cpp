#include "delaunay/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/random.h"

namespace delvox {
namespace {

std::vector<Point3> random_points(int count) {
  test::Random random(1);
  std::vector<Point3> points;
  for (int n = 0; n < count; ++n) points.push_back(random.in({{-3, 0, 100}, {5, 8, 108}}));
  return points;
}

std::vector<Point3> in_spatial_order(const std::vector<Point3>& points) {
  std::vector<Point3> ordered;
  for (std::uint32_t i : spatial_order(points)) ordered.push_back(points[i]);
  return ordered;
}

std::vector<Point3> sorted(std::vector<Point3> points) {
  std::sort(points.begin(), points.end(), [](const Point3& a, const Point3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  });
  return points;
}

TEST(SpatialOrder, IsAPermutationOfThePoints) {
  for (int count : {0, 1, 2, 63, 64, 65, 5000}) {
    const std::vector<Point3> points = random_points(count);
    EXPECT_EQ(sorted(in_spatial_order(points)), sorted(points)) << count;
  }
  const std::vector<Point3> alike(100, Point3{1, 2, 3});
  EXPECT_EQ(in_spatial_order(alike), alike);
}

TEST(SpatialOrder, IsTheSameOnEveryCallAndDoesNotDependOnTheOrderGiven) {
  const std::vector<Point3> points = random_points(5000);
  const std::vector<Point3> order = in_spatial_order(points);
  EXPECT_EQ(in_spatial_order(points), order);
  std::vector<Point3> reversed(points.rbegin(), points.rend());
  EXPECT_EQ(in_spatial_order(reversed), order);
}

TEST(SpatialOrder, NeighboursInTheLastRoundAreNearAndTheFirstPointsAreSpread) {
  const std::vector<Point3> order = in_spatial_order(random_points(8000));
  double step = 0;
  for (std::size_t i = 4001; i < order.size(); ++i) step += distance(order[i], order[i - 1]);
  EXPECT_LT(step / 3999, 1.5);  // two random points are 5.3 apart
  Box3 first;
  for (std::size_t i = 0; i < 200; ++i) first.extend(order[i]);
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(first.max[axis] - first.min[axis], 7);
}

TEST(SpatialOrder, PointsWithZeroAndMinusZeroHashAlike) {
  EXPECT_EQ(hash_point({0.0, 1, -0.0}), hash_point({-0.0, 1, 0.0}));
  std::set<std::uint64_t> hashes;
  for (const Point3& p : random_points(5000)) hashes.insert(hash_point(p));
  EXPECT_EQ(hashes.size(), 5000u);
  EXPECT_NE(hash_point({1, 2, 3}), hash_point({3, 2, 1}));
}

}  // namespace
}  // namespace delvox
