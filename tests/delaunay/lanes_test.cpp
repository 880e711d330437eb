#include "delaunay/lane.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "delaunay_checks.h"
#include "delvox/oracle/implicit_oracle.h"
#include "support/random.h"

// Insertions that are made at a time. Run under the tsan preset, these tests look for races too.

namespace delvox {
namespace {

using test::Random;

const Box3 kBox{{-1, -1, -1}, {1, 1, 1}};

std::unique_ptr<SmoothOracle> ball() {
  return make_implicit_oracle({.value = [](const Point3& p) { return norm(p - Point3{}) - 0.8; },
                               .gradient = [](const Point3& p) { return (1 / norm(p - Point3{})) * (p - Point3{}); },
                               .box = kBox,
                               .resolution = 0.1});
}

std::vector<Point3> points(std::size_t count, bool on_lattice, std::uint64_t seed) {
  Random random(seed);
  std::vector<Point3> result;
  for (std::size_t n = 0; n < count; ++n) {
    Point3 p = random.in(kBox);
    for (int axis = 0; axis < 3 && on_lattice; ++axis) p[axis] = std::round(8 * p[axis]) / 10;
    result.push_back(p);
  }
  return result;
}

void expect_same(const RestrictedDelaunay& a, const RestrictedDelaunay& b) {
  ASSERT_EQ(a.cell_capacity(), b.cell_capacity());
  ASSERT_EQ(a.vertex_capacity(), b.vertex_capacity());
  for (CellId c = 0; c < a.cell_capacity(); ++c) {
    ASSERT_EQ(a.stamp(c), b.stamp(c)) << c;
    if (a.stamp(c) == 0) continue;
    ASSERT_EQ(a.vertices(c), b.vertices(c));
    ASSERT_EQ(a.neighbors(c), b.neighbors(c));
    ASSERT_EQ(a.label(c), b.label(c));
  }
  for (VertexId v = 0; v < a.vertex_capacity(); ++v) {
    ASSERT_EQ(a.kind(v), b.kind(v));
    if (a.kind(v) != VertexKind::kRemoved) {
      ASSERT_EQ(a.cell_of(v), b.cell_of(v));
    }
  }
}

class InsertionInLanes : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Placements, InsertionInLanes, testing::Bool(),
                         [](const auto& info) { return info.param ? "OnALatticeWithDuplicates" : "AtRandom"; });

TEST_P(InsertionInLanes, IsTheSameForOneTwoAndFourThreadsAndDelaunay) {
  const auto oracle = ball();
  const std::vector<Point3> seeds = points(4000, GetParam(), 1), inside = points(3000, GetParam(), 2);
  std::vector<std::unique_ptr<RestrictedDelaunay>> made;
  for (std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    made.push_back(std::make_unique<RestrictedDelaunay>(*oracle));
    made.back()->insert_seeds(seeds);
    made.back()->insert_interior(inside, always_go_on);
    expect_same(*made.front(), *made.back());
    ASSERT_FALSE(HasFatalFailure());
  }
  test::expect_delaunay(*made.front());
  test::expect_true_cells(*made.front(), *oracle);
  EXPECT_EQ(test::used_vertices(*made.front()), made.front()->vertex_count());
}

TEST(Lanes, OnlyThoseThatShareNoVertexButFarCornersHoldTheirClaimsTheGreatestAlways) {
  const auto oracle = ball();
  RestrictedDelaunay delaunay(*oracle);
  delaunay.insert_seeds(points(300, false, 3));
  Random random(4);
  std::size_t held = 0, lost = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<Lane> lanes(12);
    std::uint32_t claim = delaunay.new_claims();
    for (Lane& lane : lanes) {
      lane.claim = claim++;
      delaunay.evaluate(random.in(kBox), delaunay.created().front(), delaunay.worker(), lane.star);
      delaunay.claim(lane);
    }
    EXPECT_TRUE(delaunay.holds(lanes.back()));
    std::vector<CellId> zones, around;
    std::vector<VertexId> vertices;
    for (Lane& lane : lanes) {
      if (!delaunay.holds(lane)) {
        ++lost;
        continue;
      }
      ++held;
      zones.insert(zones.end(), lane.star.zone.begin(), lane.star.zone.end());
      for (const Star::Tet& tet : lane.star.tets) around.push_back(tet.outer.cell);
      for (const Star::Corner& corner : lane.star.corners) {
        if (corner.vertex >= Delaunay3::kCorners) vertices.push_back(corner.vertex);
      }
    }
    std::sort(vertices.begin(), vertices.end());
    EXPECT_EQ(std::adjacent_find(vertices.begin(), vertices.end()), vertices.end());
    std::sort(zones.begin(), zones.end());
    EXPECT_EQ(std::adjacent_find(zones.begin(), zones.end()), zones.end());
    for (CellId cell : around) EXPECT_FALSE(std::binary_search(zones.begin(), zones.end(), cell));
    for (Lane& lane : lanes) delaunay.furnish(lane, true, 0);
    for (Lane& lane : lanes) {
      if (delaunay.holds(lane)) delaunay.commit(lane, VertexKind::kInterior);
    }
    for (Lane& lane : lanes) delaunay.clear_out(lane);
    test::expect_delaunay(delaunay);
    ASSERT_FALSE(testing::Test::HasFailure()) << round;
  }
  EXPECT_GT(held, 100u);
  EXPECT_GT(lost, 100u);
  EXPECT_EQ(delaunay.vertex_count(), 300 + held);
}

/// The first round of the spatial order may be one of several lanes while there is one cell.
TEST(Lanes, OneAloneMakesTheFirstInsertion) {
  const auto oracle = ball();
  for (std::size_t count = 470; count < 520; ++count) {
    RestrictedDelaunay delaunay(*oracle);
    delaunay.insert_seeds(points(count, false, count));
    EXPECT_EQ(delaunay.vertex_count(), count);
    test::expect_delaunay(delaunay);
    ASSERT_FALSE(testing::Test::HasFailure()) << count;
  }
}

/// What a vertex remembers of claims comes again after 4096 rounds.
TEST(Lanes, AreKeptByClaimsOfOldForOneRoundAtMostAndInsertionsAloneNever) {
  const auto oracle = ball();
  RestrictedDelaunay delaunay(*oracle);
  delaunay.insert_seeds(points(300, false, 6));
  const Point3 p{0.1, 0.2, 0.3};
  const auto claim_as = [&](Lane& lane, std::uint32_t claim) {
    lane.claim = claim;
    delaunay.evaluate(p, delaunay.created().front(), delaunay.worker(), lane.star);
    delaunay.claim(lane);
  };
  Lane old, lane;
  claim_as(old, delaunay.new_claims() + 5);
  for (int round = 1; round < 4096; ++round) delaunay.new_claims();
  claim_as(lane, delaunay.new_claims() + 2);
  EXPECT_FALSE(delaunay.holds(lane));
  claim_as(lane, delaunay.new_claims() + 2);
  EXPECT_TRUE(delaunay.holds(lane));

  claim_as(old, delaunay.new_claims() + 14);
  for (int round = 1; round < 4096; ++round) delaunay.new_claims();
  claim_as(lane, delaunay.new_claim());
  EXPECT_TRUE(delaunay.holds(lane));
}

TEST(Lanes, GiveBackWhatTheyDoNotUse) {
  const auto oracle = ball();
  RestrictedDelaunay delaunay(*oracle);
  delaunay.insert_seeds(points(200, false, 5));
  const auto furnish_and_clear = [&] {
    Lane lane;
    lane.claim = delaunay.new_claim();
    delaunay.evaluate({0.1, 0.2, 0.3}, delaunay.created().front(), delaunay.worker(), lane.star);
    delaunay.furnish(lane, true, 5);
    delaunay.clear_out(lane);
  };
  furnish_and_clear();
  const std::size_t cells = delaunay.cell_capacity(), vertices = delaunay.vertex_capacity();
  for (int n = 0; n < 10; ++n) furnish_and_clear();
  EXPECT_EQ(delaunay.cell_capacity(), cells);
  EXPECT_EQ(delaunay.vertex_capacity(), vertices);
  EXPECT_EQ(delaunay.vertex_count(), 200u);
}

}  // namespace
}  // namespace delvox
