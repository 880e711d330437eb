#include "meshing/interior_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

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

  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle(GetParam(), test::cubic_image(32));
  std::vector<Point3> surface_points_;
  RestrictedDelaunay delaunay_{*oracle_};
};

/// The tets inside the domain, by where their corners are.
std::set<std::array<std::array<double, 3>, 4>> tets_inside(const RestrictedDelaunay& delaunay) {
  std::set<std::array<std::array<double, 3>, 4>> tets;
  for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay.cell_capacity(); ++cell) {
    if (delaunay.stamp(cell) == 0 || delaunay.label(cell) == 0) continue;
    std::array<std::array<double, 3>, 4> tet;
    for (int i = 0; i < 4; ++i) {
      const Point3& p = delaunay.point(delaunay.vertices(cell)[i]);
      tet[i] = {p.x, p.y, p.z};
    }
    std::sort(tet.begin(), tet.end());
    tets.insert(tet);
  }
  return tets;
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
  const auto nearest = [&](const Point3& p) {
    double least = Box3::kInfinity;
    for (const Point3& q : surface_points_) least = std::min(least, distance(p, q));
    return least;
  };
  for (const InteriorLattice::ShellSite& shell : lattice.shell()) {
    const Point3 p = lattice.point(shell.site);
    EXPECT_EQ(shell.vertex, kNone);
    EXPECT_EQ(oracle_->label(p), 1);
    EXPECT_GT(nearest(p), 0.7 * kCellSize);
    for (const SurfaceBall& ball : balls) EXPECT_GT(squared_distance(p, ball.center), ball.squared_radius);
  }
}

TEST_P(InteriorLatticeTest, AddingTheDeepSitesWithTheirTetsEndsInWhatInsertingThemDoes) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  lattice.insert_shell(delaunay_, always_go_on);
  ASSERT_GT(lattice.deep().size(), 50u);
  EXPECT_LT(lattice.deep().size() + lattice.shell().size(), lattice.site_count());

  RestrictedDelaunay inserted(*oracle_);
  inserted.insert_seeds(surface_points_);
  std::vector<Point3> points;
  for (const InteriorLattice::ShellSite& shell : lattice.shell()) points.push_back(lattice.point(shell.site));
  for (InteriorLattice::Site site : lattice.deep()) points.push_back(lattice.point(site));
  inserted.insert_interior(points, always_go_on);

  const std::size_t before = delaunay_.vertex_count();
  const std::uint32_t stamp = lattice.add_deep(delaunay_);
  EXPECT_EQ(delaunay_.vertex_count(), before + lattice.deep().size());
  EXPECT_EQ(tets_inside(delaunay_), tets_inside(inserted));
  // Of those that have a deep corner, in particular of those with three corners in the shell.
  std::size_t known = 0;
  for_each_cell([&](CellId cell) {
    if (delaunay_.stamp(cell) != stamp) return;
    ++known;
    const Circumsphere& sphere = delaunay_.sphere(cell);
    for (const Point3& q : surface_points_) ASSERT_GT(squared_distance(q, sphere.center), sphere.squared_radius);
  });
  EXPECT_GT(known, 100u);
  std::size_t not_lattice = 0;
  for (CellId cell : delaunay_.created()) {
    not_lattice += std::sqrt(delaunay_.sphere(cell).squared_radius) > kCellSize;
  }
  EXPECT_GT(delaunay_.created().size(), 100u);
  EXPECT_EQ(not_lattice, 0u);
}

// As step 2 of DelTetSurf does with a site that disturbs the surface.
TEST_P(InteriorLatticeTest, ASiteThatIsRemovedMovesTheShellInward) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  lattice.insert_shell(delaunay_, always_go_on);
  EXPECT_FALSE(lattice.adapt(delaunay_));
  const std::size_t before = lattice.deep().size();
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
  EXPECT_EQ(before, lattice.deep().size() + to_insert);
  EXPECT_NO_THROW(lattice.add_deep(delaunay_));
}

// As refinement does where the shell has changed the surface.
TEST_P(InteriorLatticeTest, VerticesThatComeNearMoveTheDeepSitesInward) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  lattice.insert_shell(delaunay_, always_go_on);
  const std::size_t before = lattice.deep().size();
  // Halfway between the surface and sites of the shell: nearer to sites further in than their tets allow.
  std::size_t added = 0;
  const Point3 middle = oracle_->bounds().center();
  for (std::size_t i = 0; i < lattice.shell().size(); i += 40) {
    const Point3 p = lattice.point(lattice.shell()[i].site), q = p + 0.4 * kCellSize / norm(middle - p) * (middle - p);
    if (delaunay_.evaluate(q, delaunay_.some_cell()).duplicate) continue;
    delaunay_.commit(VertexKind::kSurface);
    surface_points_.push_back(q);
    ++added;
  }
  compute_balls();
  ASSERT_GT(added, 3u);
  ASSERT_TRUE(lattice.adapt(delaunay_));
  EXPECT_LT(lattice.deep().size(), before);
  lattice.insert_shell(delaunay_, always_go_on);
  EXPECT_FALSE(lattice.adapt(delaunay_));
  const std::uint32_t stamp = lattice.add_deep(delaunay_);
  for_each_cell([&](CellId cell) {
    if (delaunay_.stamp(cell) != stamp) return;
    const Circumsphere& sphere = delaunay_.sphere(cell);
    for (const Point3& q : surface_points_) ASSERT_GT(squared_distance(q, sphere.center), sphere.squared_radius);
  });
}

TEST_P(InteriorLatticeTest, AboutAsManySitesAreDeepAsIsExpected) {
  InteriorLattice lattice = this->lattice();
  lattice.find_depths();
  const double expected = InteriorLattice::expected_deep(delaunay_, kCellSize);
  const auto deep = static_cast<double>(lattice.deep().size());
  EXPECT_GT(expected, 0.8 * deep);
  EXPECT_LT(expected, 1.5 * deep);
  EXPECT_EQ(InteriorLattice::expected_deep(delaunay_, 40), 0);
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
  EXPECT_TRUE(none.deep().empty());
  const std::size_t cells = delaunay_.cell_capacity();
  none.add_deep(delaunay_);
  EXPECT_EQ(delaunay_.cell_capacity(), cells);
}

}  // namespace
}  // namespace delvox
