#include "delaunay/walled_region.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "delaunay/delaunay3.h"
#include "support/random.h"

namespace delvox {
namespace {

using test::Random;

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

TEST_P(WalledRegionTest, HoldsTheCellsWithinTheWallsInAnyOrder) {
  ASSERT_GT(walls_.size(), 20u);
  std::vector<Wall> walls = walls_;
  for (std::size_t i = walls.size(); i > 1; --i) std::swap(walls[i - 1], walls[random_.bits() % i]);
  for (Wall& wall : walls) std::rotate(wall.begin(), wall.begin() + random_.below(3), wall.end());
  const auto region = find_walled_region(delaunay_, walls);
  ASSERT_TRUE(region.has_value());
  EXPECT_TRUE(std::is_sorted(region->cells.begin(), region->cells.end()));
  std::vector<bool> held(delaunay_.cell_capacity(), false);
  for (CellId cell : region->cells) {
    EXPECT_FALSE(held[cell]) << "twice";
    held[cell] = true;
  }
  EXPECT_EQ(held, is_inside_);
  ASSERT_EQ(region->outside.size(), walls.size());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const FacetId outside = region->outside[w];
    EXPECT_FALSE(is_inside_[outside.cell]);
    EXPECT_EQ(canonical(delaunay_.vertices(delaunay_.mirror(outside))), canonical(walls[w]));
  }
}

TEST_P(WalledRegionTest, IsNoneIfAWallIsNoFacet) {
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
  EXPECT_TRUE(find_walled_region(delaunay_, walls_).has_value());
  EXPECT_FALSE(find_walled_region(delaunay_, walls).has_value());
}

}  // namespace
}  // namespace delvox
