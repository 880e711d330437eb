// Filling the inside with a lattice, and refinement that goes on in it: Refinement driven by hand, since deltetsurf's own
// criteria hardly ever lead there.
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
    const RestrictedDelaunay& delaunay = refinement_->delaunay();
    for (VertexId v = 0; v < delaunay.vertex_capacity(); ++v) {
      if (delaunay.kind(v) == VertexKind::kInterior) lattice_points_.push_back(delaunay.point(v));
    }
    ASSERT_GT(lattice_points_.size(), 200u);
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
    TetMesh mesh = extract_tets(refinement_->delaunay());
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

  std::size_t points_kept(const TetMesh& mesh) const {
    std::vector<std::array<double, 3>> present;
    for (const Point3& p : mesh.points) present.push_back({p.x, p.y, p.z});
    std::sort(present.begin(), present.end());
    return static_cast<std::size_t>(std::count_if(lattice_points_.begin(), lattice_points_.end(), [&](const Point3& p) {
      return std::binary_search(present.begin(), present.end(), std::array{p.x, p.y, p.z});
    }));
  }

  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle(GetParam(), test::cubic_image(40));
  SurfaceCriteria surface_;
  const TetCriteria lattice_{2, kSize};
  const RunControl control_;
  RunReport report_;
  std::optional<Refinement> refinement_;
  std::vector<Point3> lattice_points_;
};

INSTANTIATE_TEST_SUITE_P(Phantoms, LatticeFilling, testing::Values("sphere", "ellipsoid", "border"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(LatticeFilling, TheLatticeMakesOneDelaunayMeshWithTheRest) {
  const TetMesh mesh = finish(lattice_);
  EXPECT_EQ(points_kept(mesh), lattice_points_.size());
  expect_promises(mesh, lattice_.cell_size);
}

// Cells in one half must be half as large.
TEST_P(LatticeFilling, RefinementGoesOnInTheLattice) {
  const TetCriteria finer{2,
                          SizeField([](const Point3& p) { return p.x > 0.3 ? kSize / 2 : kSize; }, kSize / 2, kSize)};
  const TetMesh mesh = finish(finer);
  EXPECT_GT(mesh.points.size(), 2 * lattice_points_.size());
  EXPECT_EQ(points_kept(mesh), lattice_points_.size());
  expect_promises(mesh, finer.cell_size);
}

// A plate two voxels thick has no room for deep sites: refinement alone fills it.
TEST(LatticeFillingOfAPlate, IsLeftToRefinement) {
  const auto oracle = test::voxel_phantom_oracle("plate", test::cubic_image(40));
  SurfaceCriteria surface;
  surface.size = kSize;
  const TetCriteria tets{2, kSize};
  const RunControl control;
  RunReport report;
  Refinement refinement(*oracle, surface, control, Variant{}, report);
  refinement.start();
  refinement.refine();
  refinement.fill_interior(tets);
  EXPECT_EQ(report.interior_insertions, 0u);
  refinement.watch_tets(tets);
  do {
    refinement.refine();
  } while (refinement.repair());
  EXPECT_GT(report.interior_insertions, 100u);
  test::expect_good_tets(extract_tets(refinement.delaunay()), kSize);
}

}  // namespace
}  // namespace delvox
