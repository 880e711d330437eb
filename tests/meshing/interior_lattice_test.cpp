#include "meshing/interior_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "delaunay/circumsphere.h"
#include "delaunay/predicates.h"
#include "delvox/meshing/delsurf.h"
#include "support/shapes.h"

namespace delvox {
namespace {

constexpr double kCellSize = 0.8;

/// A refined surface of a phantom with all of its balls, and a lattice in it.
class InteriorLatticeTest : public testing::TestWithParam<const char*> {
 protected:
  InteriorLatticeTest() {
    RunReport report;
    SurfaceCriteria criteria;
    criteria.size = kCellSize;
    const SurfaceMesh surface = delsurf(*oracle_, {criteria, {}}, report);
    surface_points_ = surface.points;
    delaunay_.insert_seeds(surface.points);
    compute_balls();
  }

  void compute_balls() {
    for_each_cell([&](CellId cell) {
      for (int i = 0; i < 4; ++i) {
        if (delaunay_.bipolar({cell, i}) && delaunay_.ball({cell, i}) == nullptr) delaunay_.compute_ball({cell, i});
      }
    });
  }

  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay_.cell_capacity(); ++cell) {
      if (delaunay_.stamp(cell) != 0) visit(cell);
    }
  }

  InteriorLattice lattice(double cell_size = kCellSize) const { return {delaunay_, cell_size, always_go_on}; }

  Point3 corner(const DeepLattice& deep, std::uint32_t number) const {
    return deep.vertex(number) != kNone ? delaunay_.point(deep.vertex(number))
                                        : deep.points[number - deep.shell.size()];
  }
  double volume(const std::array<Point3, 4>& p) const { return dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6; }
  std::array<Point3, 4> points_of(const DeepLattice& deep, const std::array<std::uint32_t, 4>& tet) const {
    return {corner(deep, tet[0]), corner(deep, tet[1]), corner(deep, tet[2]), corner(deep, tet[3])};
  }
  std::vector<WalledRegion::Wall> walls_of(const DeepLattice& deep) const {
    std::vector<WalledRegion::Wall> walls;
    for (const auto& tet : deep.tets) {
      for (const auto& face : kTetFaces) {
        const WalledRegion::Wall wall{deep.vertex(tet[face[0]]), deep.vertex(tet[face[1]]), deep.vertex(tet[face[2]])};
        if (std::count(wall.begin(), wall.end(), kNone) == 0) walls.push_back(wall);
      }
    }
    return walls;
  }
  /// Positive tets of circumradii within the bound, each with a deep corner; no vertex and no deep point in their
  /// spheres.
  void expect_delaunay(const DeepLattice& deep) const;
  /// Its tets have the volume of what their walls set aside.
  void expect_to_fill_walls(const DeepLattice& deep);

  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle(GetParam(), test::cubic_image(32));
  std::vector<Point3> surface_points_;
  RestrictedDelaunay delaunay_{*oracle_};
};

void InteriorLatticeTest::expect_to_fill_walls(const DeepLattice& deep) {
  ASSERT_TRUE(delaunay_.set_aside(walls_of(deep)));
  double within_walls = 0, deep_volume = 0;
  for_each_cell([&](CellId cell) {
    if (!delaunay_.placeholder(cell)) return;
    const auto& v = delaunay_.vertices(cell);
    within_walls +=
        volume({delaunay_.point(v[0]), delaunay_.point(v[1]), delaunay_.point(v[2]), delaunay_.point(v[3])});
  });
  for (const auto& tet : deep.tets) deep_volume += volume(points_of(deep, tet));
  EXPECT_GT(deep_volume, 0);
  EXPECT_NEAR(within_walls / deep_volume, 1, 1e-12);
}

void InteriorLatticeTest::expect_delaunay(const DeepLattice& deep) const {
  std::vector<Point3> all = deep.points;
  for (VertexId v = Delaunay3::kCorners; v < delaunay_.vertex_capacity(); ++v) {
    if (delaunay_.kind(v) != VertexKind::kRemoved) all.push_back(delaunay_.point(v));
  }
  std::size_t not_positive = 0, without_deep = 0, not_empty = 0;
  double largest = 0;
  for (std::size_t t = 0; t < deep.tets.size(); ++t) {
    const auto& tet = deep.tets[t];
    const std::array<Point3, 4> p = points_of(deep, tet);
    not_positive += orientation(p[0], p[1], p[2], p[3]) <= 0;
    without_deep += std::all_of(tet.begin(), tet.end(), [&](std::uint32_t c) { return deep.vertex(c) != kNone; });
    const Circumsphere sphere = circumsphere(p[0], p[1], p[2], p[3]);
    largest = std::max(largest, std::sqrt(sphere.squared_radius));
    if (t % 7 != 0) continue;  // a sample is as good
    for (const Point3& q : all) {
      if (squared_distance(q, sphere.center) > sphere.squared_radius * (1 + 1e-6)) continue;
      if (std::count(p.begin(), p.end(), q) == 0) not_empty += in_sphere(p[0], p[1], p[2], p[3], q);
    }
  }
  EXPECT_EQ(not_positive, 0u);
  EXPECT_EQ(without_deep, 0u);
  EXPECT_EQ(not_empty, 0u);
  EXPECT_LE(largest, kCellSize);
}

INSTANTIATE_TEST_SUITE_P(Phantoms, InteriorLatticeTest, testing::Values("sphere", "ellipsoid"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(InteriorLatticeTest, SitesLieInsideClearOfTheSurfaceAndItsBalls) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  ASSERT_GT(lattice.shell().size(), 100u);
  EXPECT_LE(lattice.shell().size(), lattice.site_count());
  std::vector<SurfaceBall> balls;
  for_each_cell([&](CellId cell) {
    for (int i = 0; i < 4; ++i) {
      if (const SurfaceBall* ball = delaunay_.ball({cell, i})) balls.push_back(*ball);
    }
  });
  double nearest = Box3::kInfinity;
  for (const InteriorLattice::ShellSite& shell : lattice.shell()) {
    const Point3 p = lattice.point(shell.site);
    EXPECT_EQ(shell.vertex, kNone);
    EXPECT_EQ(oracle_->label(p), 1);
    for (const Point3& q : surface_points_) nearest = std::min(nearest, distance(p, q));
    for (const SurfaceBall& ball : balls) EXPECT_GT(squared_distance(p, ball.center), ball.squared_radius);
  }
  // Farther than the circumradius of a lattice tet: its sphere then holds no vertex of the surface.
  EXPECT_GT(nearest, 0.9 * kCellSize);
}

TEST_P(InteriorLatticeTest, DeepTetsAreDelaunayAndFillWhatTheirWallsEnclose) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  lattice.insert_shell(delaunay_, always_go_on);
  const DeepLattice deep = lattice.deep();
  ASSERT_GT(deep.points.size(), 20u);
  EXPECT_EQ(deep.points.size(), deep.labels.size());
  EXPECT_LT(deep.points.size() + deep.shell.size(), lattice.site_count());
  expect_delaunay(deep);
  for (Label label : deep.labels) EXPECT_EQ(label, 1);

  expect_to_fill_walls(deep);
}

// Piece by piece, until nothing deep is left.
TEST_P(InteriorLatticeTest, DeepPointsTakenBecomeShellAndTheRestStaysDelaunayAndFillsItsWalls) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  lattice.insert_shell(delaunay_, always_go_on);
  DeepLattice deep = lattice.deep();
  const std::size_t all = deep.points.size() + deep.shell.size();
  const Point3 place = deep.points[deep.points.size() / 3];
  for (double reach = 0; !deep.points.empty(); reach += kCellSize) {
    const std::vector<Point3> taken = deep.take_near(place, reach);
    ASSERT_FALSE(taken.empty());
    ASSERT_EQ(deep.points.size() + deep.shell.size(), all);
    EXPECT_EQ(deep.labels.size(), deep.points.size());
    double farthest_taken = 0, nearest_left = Box3::kInfinity;
    for (const Point3& p : taken) farthest_taken = std::max(farthest_taken, distance(p, place));
    for (const Point3& p : deep.points) nearest_left = std::min(nearest_left, distance(p, place));
    EXPECT_LT(farthest_taken, nearest_left);
    const std::vector<VertexId> vertices = delaunay_.insert_interior(taken, always_go_on);
    std::copy(vertices.begin(), vertices.end(), deep.shell.end() - static_cast<std::ptrdiff_t>(taken.size()));
    if (deep.points.empty()) break;
    expect_delaunay(deep);
    expect_to_fill_walls(deep);
    delaunay_.take_back();
  }
  EXPECT_TRUE(deep.tets.empty());
}

// As step 2 of DelTetSurf does with a site that disturbs the surface.
TEST_P(InteriorLatticeTest, ASiteThatIsRemovedMovesTheShellInward) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  lattice.insert_shell(delaunay_, always_go_on);
  EXPECT_FALSE(lattice.adapt(delaunay_));
  const DeepLattice before = lattice.deep();
  std::vector<InteriorLattice::Site> removed;
  for (std::size_t i = 0; i < lattice.shell().size(); i += 150) {
    delaunay_.remove(lattice.shell()[i].vertex);
    removed.push_back(lattice.shell()[i].site);
  }
  compute_balls();
  ASSERT_TRUE(lattice.adapt(delaunay_));
  std::size_t to_insert = 0;
  for (const InteriorLattice::ShellSite& shell : lattice.shell()) {
    EXPECT_EQ(std::count(removed.begin(), removed.end(), shell.site), 0);
    to_insert += shell.vertex == kNone;
    if (shell.vertex != kNone) {
      EXPECT_EQ(delaunay_.point(shell.vertex), lattice.point(shell.site));
    }
  }
  lattice.insert_shell(delaunay_, always_go_on);
  EXPECT_FALSE(lattice.adapt(delaunay_));
  const DeepLattice after = lattice.deep();
  EXPECT_EQ(before.points.size(), after.points.size() + to_insert);
  expect_delaunay(after);
  EXPECT_TRUE(delaunay_.set_aside(walls_of(after)));
}

TEST_P(InteriorLatticeTest, HasNoSitesWhereThereIsNoRoomOrTooMuchOrItIsToldToEnd) {
  EXPECT_EQ(lattice(40).site_count(), 0u);
  EXPECT_EQ(lattice(0.01).site_count(), 0u);  // billions
  EXPECT_EQ(InteriorLattice(delaunay_, kCellSize, [] { return false; }).site_count(), 0u);
  RestrictedDelaunay empty(*oracle_);
  EXPECT_EQ(InteriorLattice(empty, kCellSize, always_go_on).site_count(), 0u);
  InteriorLattice none = lattice(40);
  none.find_depths();
  EXPECT_TRUE(none.shell().empty());
  EXPECT_TRUE(none.deep().tets.empty());
}

}  // namespace
}  // namespace delvox
