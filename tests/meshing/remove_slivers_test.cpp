#include "delvox/meshing/remove_slivers.h"

#include <gtest/gtest.h>

#include <atomic>

#include "delvox/core/errors.h"
#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "phantom_cases.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

using test::PhantomCase;

struct Repaired {
  TetMesh before, mesh;
  RunReport report;
  SliverReport slivers;
};

RemoveSliversOptions options_for(double size, double min_ball_radius, double min_dihedral_degrees) {
  RemoveSliversOptions options;
  options.min_dihedral_degrees = min_dihedral_degrees;
  options.surface.size = size;
  options.surface.min_ball_radius = min_ball_radius;
  options.tets.cell_size = size;
  return options;
}

Repaired repair(const Oracle& oracle, const RemoveSliversOptions& options, double min_fold_degrees = 0) {
  Repaired result;
  result.before = deltetsurf(oracle, {options.surface, options.tets, {}, {}, min_fold_degrees}, result.report);
  result.mesh = result.before;
  result.slivers = remove_slivers(result.mesh, oracle, options, result.report);
  return result;
}

double smallest_dihedral(const TetMesh& mesh) {
  CheckOptions options;
  options.level = CheckLevel::kCheap;
  return check_mesh(mesh, options).statistics.dihedral_degrees.min;
}

class SliversOfPhantoms : public testing::TestWithParam<PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(
    Phantoms, SliversOfPhantoms,
    testing::Values(PhantomCase{"sphere", test::cubic_image(32), 2},
                    PhantomCase{"ellipsoid", test::cubic_image(32), 1.5},
                    PhantomCase{"torus", test::cubic_image(32), 1.2}, PhantomCase{"shells", test::cubic_image(28), 1.5},
                    PhantomCase{"touching-balls", test::cubic_image(32), 1.2},
                    PhantomCase{"plate", test::cubic_image(28), 0.8}, PhantomCase{"rod", test::cubic_image(28), 0.8},
                    PhantomCase{"oblique-sphere", test::oblique_image(), 1.5},
                    PhantomCase{"border", test::cubic_image(28), 1.5}, PhantomCase{"ramp", test::cubic_image(14), 1.2},
                    PhantomCase{"gyroid", test::cubic_image(20), 0.5}),
    [](const auto& info) { return test::test_name(info.param); });

TEST_P(SliversOfPhantoms, AreGoneAndEveryOtherPromiseHoldsStillTwiceAlike) {
  const PhantomCase& c = GetParam();
  const Volume volume = c.volume();
  const auto oracle = make_isosurface_oracle(volume, c.isosurface());
  const RemoveSliversOptions options = options_for(c.size, c.min_ball_radius(), 15);
  const Repaired repaired = repair(*oracle, options);
  const TetMesh& mesh = repaired.mesh;
  test::expect_finished(repaired.report);
  EXPECT_LT(smallest_dihedral(repaired.before), 15) << "nothing to repair";
  EXPECT_GE(smallest_dihedral(mesh), 15);
  EXPECT_TRUE(repaired.slivers.unmet.empty());
  EXPECT_EQ(mesh.info.promises.min_dihedral_degrees, 15);

  CheckOptions full;
  full.volume = &volume;
  full.isosurface = c.isosurface();
  const CheckReport check = check_mesh(mesh, full), before = check_mesh(repaired.before, full);
  EXPECT_TRUE(check.all_hold()) << to_text(check);
  EXPECT_EQ(check.statistics.euler, before.statistics.euler);
  EXPECT_EQ(check.statistics.surface_components, before.statistics.surface_components);
  test::expect_good_tets(mesh, c.size);
  test::expect_good_nodes(mesh, *oracle, c.voxel());
  EXPECT_EQ(mesh.regions, std::vector<Label>(mesh.tets.size(), 1));

  const TetMesh second = repair(*oracle, options).mesh;
  EXPECT_EQ(second.points, mesh.points);
  EXPECT_EQ(second.tets, mesh.tets);
  EXPECT_EQ(second.boundary, mesh.boundary);
}

TEST(RemoveSlivers, LeavesNoAngleBelowTwentyDegreesOnSmoothShapesHoweverTheyAreGiven) {
  for (const char* kind : {"sphere", "ellipsoid", "torus", "shells", "touching-balls", "gyroid"}) {
    SCOPED_TRACE(kind);
    const auto voxels = test::voxel_phantom_oracle(kind, test::cubic_image(32));
    const auto formula = test::implicit_phantom_oracle(kind, test::cubic_image(32), 0.5);
    for (const SmoothOracle* oracle : {voxels.get(), formula.get()}) {
      const Repaired repaired = repair(*oracle, options_for(1.2, 0.1, 20));
      EXPECT_GE(smallest_dihedral(repaired.mesh), 20);
      test::expect_all_checks_hold(repaired.mesh);
      test::expect_good_nodes(repaired.mesh, *oracle, 1);
    }
  }
}

// Samples without any order fold the surface and make it pieces of a tet or two: not all can be repaired, but nothing
// may break, and what is left is told.
TEST(RemoveSlivers, TellsWhatIsLeftOnNoiseAndBreaksNothing) {
  PhantomCase noise{"random", phantom_defaults("random"), 0.8, 1.3};
  noise.image.dims = {28, 28, 28};  // large enough that some are left, however it goes
  noise.image.seed = 2;
  const Volume volume = noise.volume();
  const auto oracle = make_isosurface_oracle(volume, noise.isosurface());
  const Repaired repaired = repair(*oracle, options_for(noise.size, 1e-4, 30), min_fold_for(30));
  test::expect_all_checks_hold(repaired.before);
  CheckOptions full;
  full.volume = &volume;
  full.isosurface = noise.isosurface();
  const CheckReport check = check_mesh(repaired.mesh, full);
  EXPECT_TRUE(check.all_hold()) << to_text(check);
  ASSERT_FALSE(repaired.slivers.unmet.empty());
  EXPECT_LT(repaired.slivers.unmet.size(), repaired.slivers.slivers / 4);
  EXPECT_FALSE(repaired.mesh.info.promises.min_dihedral_degrees.has_value());
  double smallest = 180;
  for (const UnmetTet& tet : repaired.slivers.unmet) {
    EXPECT_LT(tet.dihedral_degrees, 30);
    EXPECT_FALSE(tet.reason.empty());
    EXPECT_EQ(oracle->bounds().contains(tet.where), true);
    smallest = std::min(smallest, tet.dihedral_degrees);
  }
  EXPECT_NEAR(smallest, smallest_dihedral(repaired.mesh), 1e-9);
  std::size_t told = 0;
  for (const Unmet& unmet : repaired.report.unmet) told += unmet.criterion == "dihedral" ? unmet.count : 0;
  EXPECT_EQ(told, repaired.slivers.unmet.size());
}

// Of each of these one tet was left, though its surface forbids nothing, until vertices were moved together.
TEST(RemoveSlivers, MovesSeveralVerticesAtOnceWhereNoneCanAlone) {
  for (std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    PhantomCase c{"random", phantom_defaults("random"), 0.8, 1.3};
    c.image.dims = {14, 14, 14};
    c.image.seed = seed;
    const auto oracle = make_isosurface_oracle(c.volume(), c.isosurface());
    const Repaired repaired = repair(*oracle, options_for(c.size, 1e-4, 20), min_fold_for(20));
    test::expect_all_checks_hold(repaired.mesh);
    for (const UnmetTet& tet : repaired.slivers.unmet) EXPECT_TRUE(tet.surface_forbids) << tet.dihedral_degrees;
  }
}

TEST(RemoveSlivers, KeepsSizesThatVaryAndADeviationThatIsPromised) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(32));
  RemoveSliversOptions options = options_for(1, 0.1, 15);
  options.surface.size = SizeField([](const Point3& p) { return p.x > 0 ? 2.0 : 1.0; }, 1, 2);
  options.surface.max_deviation = 0.1;
  options.tets.cell_size = options.surface.size;
  const Repaired repaired = repair(*oracle, options);
  EXPECT_GE(smallest_dihedral(repaired.mesh), 15);
  for (const Tet& tet : repaired.mesh.tets) {
    const test::TetShape shape = test::shape_of(repaired.mesh, tet);
    EXPECT_LE(shape.circumradius, options.tets.cell_size(shape.circumcenter) * (1 + 1e-7));
  }
  ASSERT_TRUE(repaired.mesh.info.promises.max_deviation.has_value());
  const Volume volume = make_phantom("sphere", test::cubic_image(32));
  CheckOptions full;
  full.volume = &volume;
  full.isosurface = Isosurface{phantom_truth("sphere", test::cubic_image(32)).isovalue, false};
  const CheckReport check = check_mesh(repaired.mesh, full);
  EXPECT_TRUE(check.all_hold()) << to_text(check);
}

TEST(RemoveSlivers, LeavesAMeshWithoutSliversAsItIs) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(24));
  const RemoveSliversOptions options = options_for(2, 0.1, 15);
  Repaired repaired = repair(*oracle, options);
  const TetMesh once = repaired.mesh;
  const SliverReport again = remove_slivers(repaired.mesh, *oracle, options, repaired.report);
  EXPECT_EQ(again.slivers, 0u);
  EXPECT_EQ(repaired.mesh.points, once.points);
  EXPECT_EQ(repaired.mesh.tets, once.tets);
}

TEST(RemoveSlivers, RefusesBoundsThatMakeNoSenseAndStopsWhenCancelled) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(24));
  RunReport report;
  RemoveSliversOptions options = options_for(1, 0.1, 15);
  TetMesh mesh = deltetsurf(*oracle, {options.surface, options.tets, {}}, report);
  for (double degrees : {0.0, -1.0, 31.0}) {
    options.min_dihedral_degrees = degrees;
    EXPECT_THROW(remove_slivers(mesh, *oracle, options, report), OptionError) << degrees;
  }
  options.min_dihedral_degrees = 15;
  const std::atomic<bool> cancel = true;
  options.control.cancel = &cancel;
  EXPECT_THROW(remove_slivers(mesh, *oracle, options, report), Cancelled);
}

}  // namespace
}  // namespace delvox
