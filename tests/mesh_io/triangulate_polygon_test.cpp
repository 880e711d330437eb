#include "mesh_io/triangulate_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace delvox::mesh_io {
namespace {

double area_along_z(const std::vector<Triangle>& triangles, const std::vector<Point3>& points) {
  double area = 0;
  for (const Triangle& t : triangles) {
    const double part = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]).z / 2;
    EXPECT_GE(part, 0);
    area += part;
  }
  return area;
}

std::vector<std::uint32_t> all_of(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0u);
  return corners;
}

TEST(TriangulatePolygon, CoversAStarOnce) {
  std::vector<Point3> points;
  for (int i = 0; i < 20; ++i) {
    const double angle = i * std::numbers::pi / 10, radius = i % 2 == 0 ? 2 : 0.5;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 1});
  }
  const auto triangles = triangulate_polygon(all_of(points), points);
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), 18u);
  EXPECT_NEAR(area_along_z(*triangles, points), 10 * 2 * 0.5 * std::sin(std::numbers::pi / 10), 1e-12);
}

TEST(TriangulatePolygon, CoversAComb) {
  std::vector<Point3> points{{0, 0, 0}, {9, 0, 0}};
  for (int tooth = 4; tooth >= 0; --tooth) {
    points.push_back({2.0 * tooth + 1, 3, 0});
    points.push_back({2.0 * tooth, 3, 0});
    if (tooth > 0) points.push_back({2.0 * tooth, 1, 0});
    if (tooth > 0) points.push_back({2.0 * tooth - 1, 1, 0});
  }
  const auto triangles = triangulate_polygon(all_of(points), points);
  ASSERT_TRUE(triangles);
  EXPECT_NEAR(area_along_z(*triangles, points), 9 * 3 - 4 * 2, 1e-12);
}

TEST(TriangulatePolygon, TakesCornersInLineWithTheirNeighbours) {
  const std::vector<Point3> points{{0, 0, 0}, {0.1, 0.3, 0}, {0.2, 0.6, 0}, {-1, 0.6, 0}, {-1, 0.2, 0}, {-1, 0, 0}};
  const std::vector<std::uint32_t> corners = all_of(points);
  for (std::size_t first = 0; first < corners.size(); ++first) {
    std::vector<std::uint32_t> turned(corners);
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    const auto triangles = triangulate_polygon(turned, points);
    ASSERT_TRUE(triangles);
    EXPECT_EQ(triangles->size(), 4u);
    for (const Triangle& t : *triangles) {
      EXPECT_GT(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]).z, 1e-3) << "from corner " << first;
    }
  }
}

TEST(TriangulatePolygon, MakesNoFlatTriangleOfATriangleWithPointsOnEverySide) {
  const std::vector<Point3> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 3, 0},
                                   {0, 2, 0}, {0, 1, 0}};
  const auto triangles = triangulate_polygon(all_of(points), points);
  ASSERT_TRUE(triangles);
  for (const Triangle& t : *triangles) {
    EXPECT_GT(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]).z, 0.1);
  }
  EXPECT_NEAR(area_along_z(*triangles, points), 4.5, 1e-12);
}

TEST(TriangulatePolygon, RefusesABowTieAndTwoCorners) {
  const std::vector<Point3> points{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::uint32_t> bow_tie = all_of(points);
  EXPECT_FALSE(triangulate_polygon(bow_tie, points));
  EXPECT_FALSE(triangulate_polygon(std::span(bow_tie).first(2), points));
}

}  // namespace
}  // namespace delvox::mesh_io
