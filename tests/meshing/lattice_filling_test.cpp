// Filling the inside with a lattice, and what happens when refinement comes near the part of it that is only written
// down: Refinement driven by hand, since deltetsurf's own criteria hardly ever lead there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "delaunay/predicates.h"
#include "mesh_expectations.h"
#include "meshing/check_options.h"
#include "meshing/extract.h"
#include "meshing/refinement.h"
#include "support/shapes.h"

namespace delvox {
namespace {

constexpr double kSize = 0.8;

/// No tet's sphere holds the vertex across any of its faces. Exactly, and unique where points are cospherical.
void expect_locally_delaunay(const TetMesh& mesh) {
  std::map<Triangle, std::array<std::uint32_t, 2>> across;  // face -> a tet, its corner opposite
  std::size_t violations = 0, pairs = 0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    for (std::size_t i = 0; i < 4; ++i) {
      Triangle face{tet[(i + 1) % 4], tet[(i + 2) % 4], tet[(i + 3) % 4]};
      std::sort(face.begin(), face.end());
      const auto [known, is_new] = across.try_emplace(face, std::array{t, tet[i]});
      if (is_new) continue;
      const Tet& other = mesh.tets[known->second[0]];
      ++pairs;
      violations += in_sphere(mesh.points[other[0]], mesh.points[other[1]], mesh.points[other[2]],
                              mesh.points[other[3]], mesh.points[tet[i]]);
    }
  }
  EXPECT_GT(pairs, mesh.tets.size());
  EXPECT_EQ(violations, 0u);
}

class LatticeFilling : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    surface_.size = kSize;
    surface_.min_ball_radius = 0.1;
    refinement_.emplace(*oracle_, surface_, control_, Variant{}, report_);
    refinement_->start();
    refine_surface();
    refinement_->fill_interior(lattice_);
    ASSERT_TRUE(refinement_->deep().has_value());
    deep_points_ = refinement_->deep()->points;
    ASSERT_GT(deep_points_.size(), 50u);
  }

  void refine_surface() {
    do {
      refinement_->refine();
    } while (refinement_->repair());
  }

  /// The rest of deltetsurf.
  TetMesh finish(const TetCriteria& criteria) {
    refinement_->watch_tets(criteria);
    do {
      refinement_->refine();
    } while (refinement_->repair());
    refinement_->report_unmet();
    const auto& deep = refinement_->deep();
    TetMesh mesh = extract_tets(refinement_->delaunay(), deep ? &*deep : nullptr);
    mesh.info.promises = promises_of(surface_, criteria);
    mesh.info.complete = report_.succeeded();
    return mesh;
  }

  void expect_promises(const TetMesh& mesh, const SizeField& cell_size) const {
    test::expect_finished(report_);
    test::expect_all_checks_hold(mesh);
    test::expect_good_tets(mesh, cell_size.maximum());
    test::expect_good_nodes(mesh, *oracle_, 1);
    test::expect_closed_manifold(boundary_surface(mesh));
    test::expect_good_triangles(boundary_surface(mesh), kSize);
    expect_locally_delaunay(mesh);
    std::size_t too_large = 0;
    for (const Tet& tet : mesh.tets) {
      const test::TetShape shape = test::shape_of(mesh, tet);
      too_large += shape.circumradius > cell_size(shape.circumcenter) * (1 + 1e-7);
    }
    EXPECT_EQ(too_large, 0u);
  }

  /// Of a tet that shares a face with the deep part.
  Circumsphere sphere_at_the_wall() const {
    const RestrictedDelaunay& delaunay = refinement_->delaunay();
    for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay.cell_capacity(); ++cell) {
      if (delaunay.stamp(cell) == 0 || delaunay.placeholder(cell)) continue;
      for (CellId next : delaunay.neighbors(cell)) {
        if (delaunay.placeholder(next)) return delaunay.sphere(cell);
      }
    }
    ADD_FAILURE() << "nothing is set aside";
    return {};
  }

  Point3 farthest_from(const Point3& place) const {
    return *std::max_element(deep_points_.begin(), deep_points_.end(), [&](const Point3& a, const Point3& b) {
      return distance(a, place) < distance(b, place);
    });
  }

  std::size_t points_kept(const TetMesh& mesh) const {
    std::vector<std::array<double, 3>> present;
    for (const Point3& p : mesh.points) present.push_back({p.x, p.y, p.z});
    std::sort(present.begin(), present.end());
    return static_cast<std::size_t>(std::count_if(deep_points_.begin(), deep_points_.end(), [&](const Point3& p) {
      return std::binary_search(present.begin(), present.end(), std::array{p.x, p.y, p.z});
    }));
  }

  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle(GetParam(), test::cubic_image(40));
  SurfaceCriteria surface_;
  const TetCriteria lattice_{2, kSize};
  const RunControl control_;
  RunReport report_;
  std::optional<Refinement> refinement_;
  std::vector<Point3> deep_points_;
};

INSTANTIATE_TEST_SUITE_P(Phantoms, LatticeFilling, testing::Values("sphere", "ellipsoid", "border"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(LatticeFilling, WhatIsOnlyWrittenDownMakesOneDelaunayMeshWithTheRest) {
  const TetMesh mesh = finish(lattice_);
  EXPECT_TRUE(refinement_->deep().has_value());
  EXPECT_EQ(points_kept(mesh), deep_points_.size());
  expect_promises(mesh, lattice_.cell_size);
}

// Cells in one half must be half as large: refinement crosses the shell there, again and again, the deep sites are
// inserted after all, and the bound holds among them too.
TEST_P(LatticeFilling, RefinementThatComesNearTheDeepPartInsertsItAndGoesOnThere) {
  const TetCriteria finer{2,
                          SizeField([](const Point3& p) { return p.x > 0.3 ? kSize / 2 : kSize; }, kSize / 2, kSize)};
  const TetMesh mesh = finish(finer);
  if (refinement_->deep()) {
    for (const Point3& p : refinement_->deep()->points) EXPECT_LT(p.x, 0.3 + kSize);
  }
  EXPECT_EQ(points_kept(mesh), deep_points_.size()) << "sites that became vertices";
  expect_promises(mesh, finer.cell_size);
}

// One bad tet at the wall is enough, and what it takes is no reason to refine the rest, or to insert what is far away.
TEST_P(LatticeFilling, ASingleInsertionAtTheWallInsertsTheDeepPartAroundItUnchanged) {
  const Circumsphere sphere = sphere_at_the_wall();
  const double smaller = 0.99 * std::sqrt(sphere.squared_radius);
  const auto field = [=](const Point3& p) { return distance(p, sphere.center) < 1e-6 ? smaller : kSize; };
  const TetCriteria finer{2, SizeField(field, smaller, kSize)};
  const TetMesh mesh = finish(finer);
  const double farthest = distance(farthest_from(sphere.center), sphere.center);
  ASSERT_GT(farthest, 6 * kSize);
  ASSERT_TRUE(refinement_->deep().has_value());
  EXPECT_LT(refinement_->deep()->points.size(), deep_points_.size());
  EXPECT_GT(refinement_->deep()->points.size(), 0u);
  for (const Point3& p : refinement_->deep()->points) EXPECT_GT(distance(p, sphere.center), 3 * kSize);
  EXPECT_EQ(points_kept(mesh), deep_points_.size());
  expect_promises(mesh, finer.cell_size);
}

// What was right as long as it was only written down is judged like the rest once it is inserted: here among deep points
// that the first of them comes with.
TEST_P(LatticeFilling, TheBoundHoldsAmongDeepPointsOnceTheyAreInserted) {
  const Circumsphere sphere = sphere_at_the_wall();
  const Point3 nearest = *std::min_element(
      deep_points_.begin(), deep_points_.end(),
      [&](const Point3& a, const Point3& b) { return distance(a, sphere.center) < distance(b, sphere.center); });
  const Point3 deeper = *std::min_element(deep_points_.begin(), deep_points_.end(), [&](const Point3& a, const Point3& b) {
    const auto off = [&](const Point3& p) { return std::abs(distance(p, nearest) - 2 * kSize); };
    return off(a) < off(b);
  });
  const auto field = [=](const Point3& p) {
    return distance(p, sphere.center) < 1e-6 || distance(p, deeper) < kSize ? kSize / 2 : kSize;
  };
  const TetCriteria finer{2, SizeField(field, kSize / 2, kSize)};
  const TetMesh mesh = finish(finer);
  if (const auto& deep = refinement_->deep()) {
    EXPECT_EQ(std::count(deep->points.begin(), deep->points.end(), deeper), 0);
  }
  expect_promises(mesh, finer.cell_size);
}

}  // namespace
}  // namespace delvox
