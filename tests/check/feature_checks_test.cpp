#include "check/feature_checks.h"

#include <gtest/gtest.h>

#include "support/sharp_shapes.h"

namespace delvox {
namespace {

CheckReport checked(const Mesh& mesh, const SurfaceMesh& surface, double degrees, Promises bounds = {}) {
  CheckOptions options;
  options.surface = &surface;
  options.feature_angle_degrees = degrees;
  options.bounds = bounds;
  return check_mesh(mesh, options);
}

TEST(FeatureChecks, AFinerOrCoarserMeshOfACubeKeepsItsEdges) {
  const SurfaceMesh cube = boundary_surface(test::cube_mesh(3, 4)), finer = boundary_surface(test::cube_mesh(8, 1.5)),
                    coarser = boundary_surface(test::cube_mesh(1, 12));
  for (const SurfaceMesh& mesh : {cube, finer, coarser}) {
    const CheckReport report = checked(mesh, cube, 60);
    EXPECT_TRUE(report.all_hold()) << to_text(report);
    EXPECT_EQ(report.find("sharp edges kept")->status, CheckStatus::kPassed);
    ASSERT_TRUE(report.feature_comparison);
    EXPECT_EQ(report.feature_comparison->sharp_edges, 36u);
    EXPECT_NEAR(report.feature_comparison->length_mm, 144, 1e-9);
    EXPECT_LT(report.feature_comparison->distance_mm, 1e-12);
  }
  EXPECT_EQ(checked(finer, cube, 60).feature_comparison->kept_edges, 96u);
  EXPECT_EQ(checked(coarser, cube, 60).feature_comparison->kept_edges, 12u);
}

TEST(FeatureChecks, AMovedNodeLeavesThePartsOfItsEdgesMissing) {
  const SurfaceMesh cube = boundary_surface(test::cube_mesh(1, 12));
  SurfaceMesh moved = boundary_surface(test::cube_mesh(4, 3));
  for (Point3& p : moved.points) {
    if (p == Point3{6, 0, 0}) p.y = 0.01;
  }
  const CheckReport report = checked(moved, cube, 60);
  EXPECT_FALSE(report.all_hold());
  const Check* kept = report.find("sharp edges kept");
  EXPECT_EQ(kept->status, CheckStatus::kFailed);
  EXPECT_NEAR(kept->measured, 6, 1e-9);
  EXPECT_EQ(kept->violations, 1u);
  EXPECT_LT(distance(*kept->where, {6, 0, 0}), 1e-9);
}

TEST(FeatureChecks, ACutCornerIsMissing) {
  const SurfaceMesh cube = boundary_surface(test::cube_mesh(1, 12));
  SurfaceMesh cut = boundary_surface(test::cube_mesh(4, 3));
  for (Point3& p : cut.points) {
    if (p == Point3{0, 0, 0}) p = {1, 1, 1};
  }
  EXPECT_NEAR(checked(cut, cube, 60).feature_comparison->missing_mm, 9, 1e-9);
}

TEST(FeatureChecks, BoundsOnShapesHoldForWhatHasNoNodeOnThem) {
  // Every triangle of a cube of two parts has a node on an edge, of a cube of six not.
  Promises bounds;
  bounds.min_angle_degrees = 50;
  bounds.radius_edge = 0.6;
  bounds.min_dihedral_degrees = 60;
  for (const int parts : {2, 6}) {
    const TetMesh mesh = test::cube_mesh(parts, 12.0 / parts);
    const CheckReport report = checked(mesh, boundary_surface(mesh), 60, bounds);
    const CheckStatus expected = parts == 2 ? CheckStatus::kPassed : CheckStatus::kFailed;
    EXPECT_EQ(report.find("angle")->status, expected);
    const FeatureComparison& features = *report.feature_comparison;
    EXPECT_EQ(features.below_min_angle, features.triangles);  // all are right-angled and isosceles
    EXPECT_GT(features.triangles, 0u);
    EXPECT_EQ(features.above_radius_edge, features.tets);
    EXPECT_EQ(features.below_min_dihedral, features.tets);
    EXPECT_NE(to_text(report).find(std::to_string(features.triangles) + " triangles"), std::string::npos);
  }
}

TEST(FeatureChecks, WithoutTheSurfaceBoundsOnShapesAreNotLookedAt) {
  SurfaceMesh mesh = boundary_surface(test::cube_mesh(3, 4));
  mesh.info.promises.min_angle_degrees = 50;
  EXPECT_FALSE(check_mesh(mesh).all_hold());
  mesh.info.promises.feature_angle_degrees = 60;
  const CheckReport report = check_mesh(mesh);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  EXPECT_EQ(report.find("sharp edges kept")->status, CheckStatus::kNotApplicable);
  EXPECT_EQ(report.find("angle")->status, CheckStatus::kNotApplicable);
  // A mesh that names its edges is held to the bounds away from them.
  mesh.features = {{0, 1}};
  EXPECT_EQ(check_mesh(mesh).find("angle")->status, CheckStatus::kFailed);
}

}  // namespace
}  // namespace delvox
