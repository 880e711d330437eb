// Tets that are known put in place of what their walls enclose, against inserting their points one by one.
#include "delaunay/known_tets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "delaunay_checks.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

using test::Random;
using test::unit_ball;
using Coordinates = std::array<double, 3>;

Coordinates coordinates(const Point3& p) {
  return {p.x, p.y, p.z};
}

/// Two triangulations of points around some balls: one has the points in the balls too. What lies between the ball's
/// vertices and those around them is known from it to the other.
class KnownTetsTest : public testing::TestWithParam<int> {
 protected:
  KnownTetsTest() : random_(static_cast<std::uint64_t>(GetParam())) {
    std::vector<Point3> centers, around, within;
    for (int ball = 0; ball < GetParam(); ++ball) centers.push_back(0.45 * random_.direction());
    for (int n = 0; n < 2500; ++n) {
      const Point3 p = 0.95 * random_.unit() * random_.direction();
      const bool near = std::any_of(centers.begin(), centers.end(),
                                    [&](const Point3& center) { return distance(center, p) < 0.25; });
      (near ? within : around).push_back(p);
    }
    around.push_back({0.9, 0, 0});
    whole_.insert_seeds({around.front(), around.back()});
    part_.insert_seeds({around.front(), around.back()});
    whole_.insert_interior(around, always_go_on);
    part_.insert_interior(around, always_go_on);
    for (VertexId v = 0; v < part_.vertex_capacity(); ++v) vertex_at_[coordinates(part_.point(v))] = v;
    const std::size_t first = whole_.vertex_capacity();
    whole_.insert_interior(within, always_go_on);
    describe(static_cast<VertexId>(first));
  }

  /// All of the whole triangulation's cells at vertices from `first` on, numbered as the part would have them.
  void describe(VertexId first) {
    const auto is_new = [&](VertexId v) { return v >= first; };
    std::map<CellId, std::size_t> number;
    test::for_each_cell(whole_, [&](CellId cell) {
      if (!test::finite(whole_, cell)) return;
      const auto& v = whole_.vertices(cell);
      if (std::any_of(v.begin(), v.end(), is_new)) number.emplace(cell, number.size());
    });
    for (VertexId v = first; v < whole_.vertex_capacity(); ++v) known_.points.push_back(whole_.point(v));
    const auto translated = [&](VertexId v) {
      return is_new(v) ? static_cast<VertexId>(part_.vertex_capacity()) + v - first
                       : vertex_at_.at(coordinates(whole_.point(v)));
    };
    const auto first_cell = static_cast<CellId>(part_.cell_capacity());
    for (const auto& [cell, n] : number) {
      KnownTets::Tet tet;
      for (int i = 0; i < 4; ++i) {
        tet.vertices[i] = translated(whole_.vertices(cell)[i]);
        const auto beyond = number.find(whole_.neighbors(cell)[i]);
        tet.neighbors[i] = beyond == number.end() ? kNone : first_cell + static_cast<CellId>(beyond->second);
        if (beyond != number.end()) continue;
        const auto wall = whole_.vertices(FacetId{cell, i});
        known_.walls.push_back({translated(wall[0]), translated(wall[1]), translated(wall[2])});
        known_.inside.push_back({first_cell + static_cast<CellId>(n), i});
      }
      tet.label = whole_.label(cell);
      tets_.push_back(tet);
    }
    known_.count = tets_.size();
    known_.tet = [this](std::size_t n) { return tets_[n]; };
  }

  using Complex = std::set<std::array<Coordinates, 4>>;
  static Complex complex(const RestrictedDelaunay& delaunay) {
    Complex tets;
    test::for_each_cell(delaunay, [&](CellId cell) {
      if (!test::finite(delaunay, cell)) return;
      std::array<Coordinates, 4> tet;
      for (int i = 0; i < 4; ++i) tet[i] = coordinates(delaunay.point(delaunay.vertices(cell)[i]));
      std::sort(tet.begin(), tet.end());
      tets.insert(tet);
    });
    return tets;
  }

  std::unique_ptr<SmoothOracle> oracle_ = unit_ball();
  RestrictedDelaunay whole_{*oracle_}, part_{*oracle_};
  Random random_;
  std::map<Coordinates, VertexId> vertex_at_;
  std::vector<KnownTets::Tet> tets_;
  KnownTets known_;
};

INSTANTIATE_TEST_SUITE_P(Balls, KnownTetsTest, testing::Values(1, 2, 5));

TEST_P(KnownTetsTest, AreWhatInsertingTheirPointsEndsIn) {
  ASSERT_GT(known_.points.size(), 20u);
  ASSERT_NE(complex(part_), complex(whole_));
  const auto stamp = part_.replace(known_);
  ASSERT_TRUE(stamp);
  std::size_t with_stamp = 0;
  test::for_each_cell(part_, [&](CellId cell) { with_stamp += part_.stamp(cell) == *stamp ? 1u : 0u; });
  EXPECT_EQ(with_stamp, tets_.size());
  EXPECT_EQ(complex(part_), complex(whole_));
  EXPECT_EQ(part_.vertex_count(), whole_.vertex_count());
  test::expect_delaunay(part_);
  test::expect_true_cells(part_, *oracle_);
  test::for_each_cell(part_, [&](CellId cell) {
    if (!test::finite(part_, cell)) return;
    for (VertexId v : part_.vertices(cell)) {
      const CellId known = part_.cell_of(v);
      ASSERT_NE(part_.stamp(known), 0u);
      ASSERT_EQ(std::count(part_.vertices(known).begin(), part_.vertices(known).end(), v), 1);
    }
  });
  for (CellId cell : part_.created()) EXPECT_GE(cell + tets_.size(), part_.cell_capacity());
}

// Its cells and vertices are like others afterwards.
TEST_P(KnownTetsTest, AreInsertedIntoAndRemovedFrom) {
  ASSERT_TRUE(part_.replace(known_));
  const auto first = static_cast<VertexId>(part_.vertex_capacity() - known_.points.size());
  for (int n = 0; n < 300; ++n) {
    const Point3 p = 0.9 * random_.unit() * random_.direction();
    if (part_.evaluate(p, part_.some_cell()).duplicate) continue;
    part_.commit(VertexKind::kInterior);
    const auto victim = first + static_cast<VertexId>(random_.below(static_cast<int>(known_.points.size())));
    if (n % 5 == 0 && part_.kind(victim) == VertexKind::kInterior) part_.remove(victim);
  }
  test::expect_delaunay(part_);
  test::expect_true_cells(part_, *oracle_);
}

TEST_P(KnownTetsTest, WithAWallThatIsNoFacetChangeNothing) {
  const Complex before = complex(part_);
  std::swap(known_.walls.front()[0], known_.walls.back()[1]);
  EXPECT_FALSE(part_.replace(known_));
  EXPECT_EQ(complex(part_), before);
  test::expect_delaunay(part_);
}

}  // namespace
}  // namespace delvox
