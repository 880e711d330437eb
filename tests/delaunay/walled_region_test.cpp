#include "delaunay/walled_region.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"

namespace delvox {
namespace {

using test::Random;
using Wall = WalledRegion::Wall;

const Box3 kBox{{-1, -1, -1}, {1, 1, 1}};

/// A triangulation of random points, and a part of it: the cells whose circumcentres lie in one of some balls.
class WalledRegionTest : public testing::TestWithParam<int> {
 protected:
  WalledRegionTest() : delaunay_(kBox), random_(static_cast<std::uint64_t>(GetParam())) {
    for (int n = 0; n < 1500; ++n) insert(random_.in(kBox));
    std::vector<Point3> centers;
    for (int ball = 0; ball < GetParam(); ++ball) centers.push_back(0.45 * random_.direction());
    is_inside_.assign(delaunay_.cell_capacity(), false);
    for_each_cell([&](CellId cell) {
      is_inside_[cell] = std::any_of(centers.begin(), centers.end(), [&](const Point3& center) {
        return distance(center, delaunay_.sphere(cell).center) < 0.3;
      });
    });
    for_each_cell([&](CellId cell) {
      for (int i = 0; i < 4 && is_inside_[cell]; ++i) {
        if (!is_inside_[delaunay_.neighbors(cell)[i]]) walls_.push_back(delaunay_.vertices(FacetId{cell, i}));
      }
    });
  }

  void insert(const Point3& p) {
    delaunay_.evaluate(p, delaunay_.cell_of(0), star_);
    delaunay_.commit(star_, created_);
  }

  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (CellId cell = Delaunay3::kOutside + 1; cell < delaunay_.cell_capacity(); ++cell) {
      if (delaunay_.stamp(cell) != 0) visit(cell);
    }
  }

  Delaunay3 delaunay_;
  Random random_;
  Star star_;
  std::vector<CellId> created_;
  std::vector<bool> is_inside_;
  std::vector<Wall> walls_;
};

INSTANTIATE_TEST_SUITE_P(Balls, WalledRegionTest, testing::Values(1, 2, 5));

TEST_P(WalledRegionTest, HoldsTheCellsWithinTheWallsInAnyOrderAndGuardsTheirNeighbours) {
  ASSERT_GT(walls_.size(), 20u);
  std::vector<Wall> walls = walls_;
  for (std::size_t i = walls.size(); i > 1; --i) std::swap(walls[i - 1], walls[random_.bits() % i]);
  for (Wall& wall : walls) std::rotate(wall.begin(), wall.begin() + random_.below(3), wall.end());
  WalledRegion region;
  EXPECT_TRUE(region.empty());
  ASSERT_TRUE(region.enclose(delaunay_, walls));
  EXPECT_FALSE(region.empty());
  for_each_cell([&](CellId cell) {
    const auto& around = delaunay_.neighbors(cell);
    const bool beside = std::any_of(around.begin(), around.end(), [&](CellId c) { return is_inside_[c]; });
    EXPECT_EQ(region.inside(cell), is_inside_[cell]);
    EXPECT_EQ(region.guarded(cell), is_inside_[cell] || beside);
  });
  region.clear();
  EXPECT_TRUE(region.empty());
  for_each_cell([&](CellId cell) { EXPECT_FALSE(region.inside(cell) || region.guarded(cell)); });
}

TEST_P(WalledRegionTest, AWallThatIsNoFacetMakesItEmpty) {
  std::vector<Wall> walls = walls_;
  VertexId far = walls.front()[0];  // any vertex that makes no facet with the two others
  const auto is_facet = [&](const Wall& wall) {
    bool found = false;
    for_each_cell([&](CellId cell) {
      for (int i = 0; i < 4; ++i) found |= canonical(delaunay_.vertices(FacetId{cell, i})) == canonical(wall);
    });
    return found;
  };
  do {
    far = Delaunay3::kCorners + static_cast<VertexId>(random_.below(1500));
  } while (far == walls[0][1] || far == walls[0][2] || is_facet({far, walls[0][1], walls[0][2]}));
  walls[0][0] = far;
  WalledRegion region;
  ASSERT_TRUE(region.enclose(delaunay_, walls_));
  EXPECT_FALSE(region.enclose(delaunay_, walls));
  EXPECT_TRUE(region.empty());
}

// What its user relies on: insertions that touch no guarded cell leave the region as it is, and their cells out of it.
TEST_P(WalledRegionTest, InsertionsThatTouchNoGuardedCellLeaveItAlone) {
  WalledRegion region;
  ASSERT_TRUE(region.enclose(delaunay_, walls_));
  std::vector<std::uint32_t> stamps(is_inside_.size());
  for_each_cell([&](CellId cell) { stamps[cell] = delaunay_.stamp(cell); });
  int inserted = 0, refused = 0;
  for (int n = 0; n < 1000; ++n) {
    delaunay_.evaluate(random_.in(kBox), delaunay_.cell_of(0), star_);
    if (std::any_of(star_.zone.begin(), star_.zone.end(), [&](CellId c) { return region.guarded(c); })) {
      ++refused;
      continue;
    }
    delaunay_.commit(star_, created_);
    ++inserted;
    for (CellId cell : created_) EXPECT_FALSE(region.inside(cell));
  }
  EXPECT_GT(inserted, 50);
  EXPECT_GT(refused, 5);
  for (CellId cell = 0; cell < is_inside_.size(); ++cell) {
    if (!is_inside_[cell]) continue;
    EXPECT_EQ(delaunay_.stamp(cell), stamps[cell]);
    EXPECT_TRUE(region.inside(cell));
  }
}

}  // namespace
}  // namespace delvox
