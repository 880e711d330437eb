#include "delvox/meshing/delsurf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "mesh_expectations.h"
#include "phantom_cases.h"

namespace delvox {
namespace {

using test::PhantomCase;

class DelSurfOnPhantoms : public testing::TestWithParam<PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(
    Phantoms, DelSurfOnPhantoms,
    testing::Values(PhantomCase{"sphere", test::cubic_image(32), 2},
                    PhantomCase{"ellipsoid", test::cubic_image(32), 1.5},
                    PhantomCase{"torus", test::cubic_image(32), 1.2}, PhantomCase{"shells", test::cubic_image(32), 1.5},
                    PhantomCase{"touching-balls", test::cubic_image(32), 1.2},
                    PhantomCase{"plate", test::cubic_image(28), 0.8}, PhantomCase{"rod", test::cubic_image(28), 0.8},
                    PhantomCase{"oblique-sphere", test::oblique_image(), 1.5},
                    PhantomCase{"border", test::cubic_image(28), 1.5}, PhantomCase{"ramp", test::cubic_image(14), 1.2},
                    PhantomCase{"gyroid", test::cubic_image(24), 0.5},
                    PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(14), 0.7), 0.5},
                    PhantomCase{"random", test::cubic_image(7), 0.5, 1.3}),
    [](const auto& info) { return test::test_name(info.param); });

TEST_P(DelSurfOnPhantoms, GivesAClosedManifoldOfTheRightTopologyWithinAllBoundsTwiceAlike) {
  const PhantomCase& c = GetParam();
  const Volume volume = c.volume();
  const auto oracle = make_isosurface_oracle(volume, c.isosurface());
  DelSurfOptions options;
  options.surface.size = c.size;
  options.surface.min_ball_radius = c.min_ball_radius();
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_finished(report);
  EXPECT_TRUE(mesh.info.complete);
  EXPECT_EQ(mesh.info.promises.size, c.size);
  test::expect_closed_manifold(mesh);
  test::expect_good_triangles(mesh, c.size);
  test::expect_all_checks_hold(mesh);
  for (const Point3& p : mesh.points) test::expect_on_surface(*oracle, p, c.voxel());

  const test::SurfaceTopology found = test::topology_of(mesh);
  const VoxelTopology voxels = count_topology(volume, c.isosurface());
  EXPECT_EQ(found.components, voxels.surface_components);
  EXPECT_EQ(found.euler, voxels.euler);
  const PhantomTruth truth = phantom_truth(c.kind, c.image);
  if (truth.components && !c.isovalue) {
    EXPECT_EQ(found.components, static_cast<std::size_t>(*truth.components));
  }
  if (truth.euler && !c.isovalue) {
    EXPECT_EQ(found.euler, *truth.euler);
  }
  EXPECT_NEAR(test::enclosed_volume(mesh), voxels.volume_mm3, 0.5 * c.size * c.size * test::area_of(mesh) / 4);

  RunReport second_report;
  const SurfaceMesh second = delsurf(*oracle, options, second_report);
  EXPECT_EQ(second.points, mesh.points);
  EXPECT_EQ(second.triangles, mesh.triangles);
  EXPECT_EQ(second_report.surface_insertions, report.surface_insertions);
}

TEST(DelSurf, TakesAnySizeAndLosesNoComponent) {
  const auto oracle = test::voxel_phantom_oracle("shells", test::cubic_image(24));  // radii 9.6, 6 and 3
  for (double size : {1.0, 2.5, 4.0, 8.0, 20.0, 1000.0}) {
    DelSurfOptions options;
    options.surface.size = size;
    RunReport report;
    const SurfaceMesh mesh = delsurf(*oracle, options, report);
    test::expect_finished(report);
    test::expect_closed_manifold(mesh);
    // Wider than the walls, a mesh may pierce them; but each wall is there.
    const test::SurfaceTopology topology = test::topology_of(mesh);
    if (size <= 4) {
      EXPECT_EQ(topology.components, 3u) << size;
      EXPECT_EQ(topology.euler, 6) << size;
    }
    for (double radius : {9.6, 6.0, 3.0}) {
      const auto near = std::count_if(mesh.points.begin(), mesh.points.end(),
                                      [&](const Point3& p) { return std::abs(norm(p) - radius) < 0.5; });
      EXPECT_GE(near, 4) << radius << " at size " << size;
    }
  }
}

TEST(DelSurf, BelowMeshesTheComplement) {
  // Turned round, the inside is what was outside: the cavity between the shells' walls, and all the image around.
  const Volume volume = make_phantom("shells", test::cubic_image(24));
  const auto oracle = make_isosurface_oracle(volume, {0, true});
  DelSurfOptions options;
  options.surface.size = 1.5;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_closed_manifold(mesh);
  test::expect_all_checks_hold(mesh);
  EXPECT_EQ(test::topology_of(mesh).components, 4u);  // three walls and the image border
  const double inside = *phantom_truth("shells", test::cubic_image(24)).volume_mm3;
  EXPECT_NEAR(test::enclosed_volume(mesh), 24.0 * 24 * 24 - inside, 0.03 * inside);
}

TEST(DelSurf, TellsOfTiesThatItCouldNotMeshAsAManifold) {
  // Samples at the isovalue are specks and necks of 1e-7 voxel: no mesh follows those. But none may hide it either.
  int not_manifold = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    PhantomOptions image = test::cubic_image(8);
    image.seed = seed;
    const auto oracle = test::voxel_phantom_oracle("random", image);
    DelSurfOptions options;
    options.surface.size = 0.5;
    options.surface.min_ball_radius = 0.1;
    RunReport report;
    const SurfaceMesh mesh = delsurf(*oracle, options, report);
    test::expect_good_triangles(mesh, 0.5);
    const test::SurfaceTopology topology = test::topology_of(mesh);
    EXPECT_EQ(topology.unused_points, 0u);
    const bool manifold = topology.open_or_crowded_edges == 0 && topology.singular_vertices == 0;
    const bool told = std::any_of(report.unmet.begin(), report.unmet.end(),
                                  [](const Unmet& unmet) { return unmet.criterion == "topology" && unmet.count > 0; });
    EXPECT_EQ(told, !manifold);
    EXPECT_EQ(mesh.info.complete, manifold);
    not_manifold += !manifold;
  }
  EXPECT_GT(not_manifold, 0);  // else this tests nothing
}

// Rods of 1e-7 voxel: each halving of the balls along them takes twice as many, down to ten million per voxel.
TEST(DelSurf, GivesUpWhereTiesWouldTakeEverSmallerTriangles) {
  const auto oracle = test::voxel_phantom_oracle("random", test::cubic_image(16));
  DelSurfOptions options;
  options.surface.size = 1.5;
  options.surface.thin_ball_radius = 0.25;
  options.control.limits.max_vertices = 60000;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  EXPECT_EQ(report.stop, StopReason::kFinished);
  test::expect_good_triangles(mesh, 1.5);
  ASSERT_FALSE(report.unmet.empty());
  EXPECT_EQ(report.unmet[0].criterion, "topology");
  EXPECT_TRUE(report.unmet[0].breaks_promise);
  EXPECT_FALSE(mesh.info.complete);
}

// Samples of a symmetric volume that lie on the surface itself are landmarks that no mesh can have on one side: without
// a smallest ball such a run once never ended.
TEST(DelSurf, EndsWithoutASmallestBallWhereGridPointsLieOnTheSurface) {
  const auto oracle = test::voxel_phantom_oracle("gyroid", test::cubic_image(16));
  DelSurfOptions options;
  options.surface.size = 0.5;
  options.control.limits.max_seconds = 60;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_finished(report);
  test::expect_closed_manifold(mesh);
}

TEST(DelSurf, MeshesASingleVoxelThroughItsPadding) {
  VolumeHeader header;
  header.dims = {1, 1, 1};
  const auto oracle = make_isosurface_oracle(Volume(header, {5.0f}), {2, false});
  DelSurfOptions options;
  options.surface.size = 0.2;
  options.surface.min_ball_radius = 0.05;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_closed_manifold(mesh);
  EXPECT_EQ(test::topology_of(mesh).euler, 2);
  EXPECT_EQ(test::topology_of(mesh).components, 1u);
}

TEST(DelSurf, WithoutTopoDiskItSkipsTheTopologyStep) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(24));
  DelSurfOptions options;
  options.surface.size = 2;
  options.surface.topo_disk = false;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*oracle, options, report);
  EXPECT_EQ(report.topology_insertions, 0u);
  EXPECT_FALSE(mesh.triangles.empty());
}

/// A ball that is said to be a torus.
class MiscountedBall final : public Oracle {
 public:
  MiscountedBall()
      : ball_(make_isosurface_oracle(make_phantom("sphere", test::cubic_image(14)),
                                     {phantom_truth("sphere", test::cubic_image(14)).isovalue, false})) {}
  Box3 bounds() const override { return ball_->bounds(); }
  Label label(const Point3& p) const override { return ball_->label(p); }
  Point3 intersect(const Point3& a, const Point3& b) const override { return ball_->intersect(a, b); }
  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    return ball_->intersect_all(a, b);
  }
  Seeds seeds(const SizeField& size, const GoOn& go_on) const override { return ball_->seeds(size, go_on); }
  Landmarks landmarks(const SizeField& size, const GoOn& go_on) const override {
    return ball_->landmarks(size, go_on);
  }
  std::optional<SurfaceTopology> topology() const override { return SurfaceTopology{1, 0}; }
  std::unique_ptr<Oracle> clone() const override { return std::make_unique<MiscountedBall>(); }

 private:
  std::unique_ptr<SmoothOracle> ball_;
};

TEST(DelSurf, ATopologyThatCannotBeReachedIsToldAndTakesFewVertices) {
  const MiscountedBall oracle;
  DelSurfOptions options;
  options.surface.size = 0.5;
  RunReport report;
  const SurfaceMesh mesh = delsurf(oracle, options, report);
  test::expect_closed_manifold(mesh);
  ASSERT_EQ(report.unmet.size(), 1u);
  EXPECT_EQ(report.unmet[0].criterion, "topology");
  EXPECT_TRUE(report.succeeded());
  options.surface.size = 1;  // too coarse to be asked for
  const SurfaceMesh coarse = delsurf(oracle, options, report);
  EXPECT_TRUE(report.unmet.empty());
  EXPECT_LT(mesh.points.size(), 8 * coarse.points.size());
}

}  // namespace
}  // namespace delvox
