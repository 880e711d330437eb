#include "meshing/feature_segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "delvox/core/errors.h"
#include "delvox/oracle/polygon_oracle.h"
#include "support/sharp_shapes.h"

namespace delvox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

FeatureEdges edges_of(const SurfaceMesh& mesh, double degrees) {
  return *make_polygon_oracle(mesh)->feature_edges(degrees);
}

TEST(FeatureLines, OfACubeOfManyPartsAreItsTwelveEdges) {
  const std::vector<FeatureLine> lines = feature_lines(edges_of(boundary_surface(test::cube_mesh(5, 2)), 60), 1e-9);
  ASSERT_EQ(lines.size(), 12u);
  for (const FeatureLine& line : lines) {
    EXPECT_EQ(line.points.size(), 6u);
    EXPECT_EQ(line.edges.size(), 5u);
    EXPECT_NEAR(line.length(), 10, 1e-12);
    EXPECT_NEAR(distance(line.point(3), line.points.front()), 3, 1e-12);
    EXPECT_EQ(line.point(10), line.points.back());
  }
}

TEST(FeatureLines, OfClosedCurvesAreCutWhereTheyTurn) {
  // The rims of a cylinder are sharp, its sides' edges are not.
  EXPECT_EQ(feature_lines(edges_of(test::polygonal_cylinder(36, 5, 10), 60), 1e-9).size(), 72u);
}

TEST(FeatureLines, BendsWithinTheToleranceAreStraight) {
  SurfaceMesh cube = boundary_surface(test::cube_mesh(2, 5));
  for (Point3& p : cube.points) {
    if (p == Point3{5, 0, 0}) p.y -= 1e-3;
  }
  EXPECT_EQ(feature_lines(edges_of(cube, 60), 1e-4).size(), 13u);
  EXPECT_EQ(feature_lines(edges_of(cube, 60), 1e-2).size(), 12u);
}

class OfShapes : public ::testing::TestWithParam<int> {
 protected:
  static SurfaceMesh shape() {
    switch (GetParam()) {
      case 0: return test::notched_cube();
      case 1: return test::polygonal_cylinder(36, 5, 10);
      case 2: return test::wedge(20);
      case 3: return test::pyramid(20);
      default: return test::icosphere(0, 10);
    }
  }
};

TEST_P(OfShapes, SegmentsCoverAllEdgesAreShorterThanTheSizeAndNotEncroachedOn) {
  const FeatureEdges edges = edges_of(shape(), 30);
  const FeatureSegments segments(edges, 0.7, kInfinity, 1e-4);
  double of_edges = 0, of_segments = 0;
  for (const FeatureEdges::Edge& edge : edges.edges) {
    of_edges += distance(edges.points[edge.ends[0]], edges.points[edge.ends[1]]);
  }
  for (std::uint32_t s = 0; s < segments.segment_count(); ++s) {
    of_segments += segments.length(s);
    EXPECT_LE(segments.length(s), 0.9 * 0.7 * (1 + 1e-9));
  }
  EXPECT_NEAR(of_segments / of_edges, 1, 1e-12);
  for (std::uint32_t n = 0; n < segments.node_count(); ++n) {
    for (std::uint32_t s = 0; s < segments.segment_count(); ++s) {
      const Edge& ends = segments.segment(s).ends;
      if (ends[0] == n || ends[1] == n) continue;
      EXPECT_GT(distance(segments.node(n), segments.middle(s)), 0.5 * segments.length(s));
    }
  }
}

TEST_P(OfShapes, HalvingSegmentsLeavesNoneEncroachedOnOnceWhatIsIsHalvedToo) {
  FeatureSegments segments(edges_of(shape(), 30), 2, kInfinity, 1e-4);
  for (std::uint32_t s = 0; s < segments.segment_count() && s < 200; s += 7) {
    std::vector<std::uint32_t> fresh{segments.split(s)};
    std::size_t splits = 0;
    while (!fresh.empty()) {
      const std::uint32_t node = fresh.back();
      fresh.pop_back();
      while (const auto next = segments.encroached_by(segments.node(node), node)) {
        ASSERT_TRUE(segments.may_split(*next));
        ASSERT_LT(++splits, 50u);
        fresh.push_back(segments.split(*next));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FeatureSegments, OfShapes, ::testing::Range(0, 5));

TEST(FeatureSegments, AtSharpCornersAllAreOfOneLength) {
  const FeatureSegments segments(edges_of(test::pyramid(20), 20), 3, kInfinity, 1e-4);
  for (std::uint32_t n = 0; n < segments.node_count(); ++n) {
    if (segments.at(n).size() < 3) continue;
    for (std::uint32_t s : segments.at(n)) EXPECT_NEAR(segments.length(s), segments.length(segments.at(n)[0]), 1e-9);
  }
}

TEST(FeatureSegments, AskOftenWhileALongLineIsCutWhetherToGoOn) {
  const FeatureEdges edges = edges_of(boundary_surface(test::cube_mesh(1, 10)), 60);
  int asked = 0;
  const auto stop = [&asked]() -> bool {
    if (++asked == 100) throw Cancelled();
    return true;
  };
  EXPECT_THROW(FeatureSegments(edges, 1e-3, kInfinity, 1e-6, stop), Cancelled);
}

TEST(FeatureSegments, WhatEncroachesMostComesFirstAndSegmentsAtANodeAreLeftOut) {
  const FeatureSegments segments(edges_of(boundary_surface(test::cube_mesh(1, 10)), 60), 20, kInfinity, 1e-4);
  ASSERT_EQ(segments.segment_count(), 12u);
  EXPECT_FALSE(segments.encroached_by({5, 5, 5}));
  const auto edge = segments.encroached_by({5, 0.5, 0.5});
  ASSERT_TRUE(edge);
  EXPECT_EQ(segments.middle(*edge), (Point3{5, 0, 0}));
  EXPECT_TRUE(segments.encroached_by({0, 0, 0}));
  for (std::uint32_t n = 0; n < segments.node_count(); ++n) EXPECT_FALSE(segments.encroached_by(segments.node(n), n));
}

}  // namespace
}  // namespace delvox
