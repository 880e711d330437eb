#include "check/surface_checks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/test_meshes.h"

namespace delvox {
namespace {

TEST(SurfaceChecks, AMeshIsAtNoDistanceFromItself) {
  const SurfaceMesh sphere = test::icosphere(3);
  CheckOptions options;
  options.surface = &sphere;
  options.require_same_topology = true;
  const CheckReport report = check_mesh(sphere, options);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  ASSERT_TRUE(report.surface_comparison);
  EXPECT_LT(report.surface_comparison->distances.mesh_to_surface_max_mm, 1e-7);
  EXPECT_LT(report.surface_comparison->distances.surface_to_mesh_max_mm, 1e-7);
}

TEST(SurfaceChecks, DistancesOfConcentricSpheresAreTheDifferenceOfTheirRadii) {
  const SurfaceMesh inner = test::icosphere(5, 1), outer = test::icosphere(5, 1.25);
  CheckOptions options;
  options.surface = &outer;
  const CheckReport report = check_mesh(inner, options);
  const SurfaceDistances& d = report.surface_comparison->distances;
  for (double distance : {d.mesh_to_surface_max_mm, d.mesh_to_surface_mean_mm, d.surface_to_mesh_max_mm,
                          d.surface_to_mesh_mean_mm}) {
    EXPECT_NEAR(distance, 0.25, 2e-3);
  }
  EXPECT_NEAR(report.find("nodes on the surface")->measured, 0.25, 2e-3);
}

TEST(SurfaceChecks, WhatOnlyOneOfTheTwoHasShowsInOneDirection) {
  const SurfaceMesh mesh = test::icosphere(3);
  SurfaceMesh two = mesh;
  test::append(two, test::icosphere(3, 1, {10, 0, 0}));
  CheckOptions options;
  options.surface = &two;
  options.require_same_topology = true;
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_LT(report.surface_comparison->distances.mesh_to_surface_max_mm, 1e-7);
  EXPECT_NEAR(report.surface_comparison->distances.surface_to_mesh_max_mm, 10, 0.01);
  EXPECT_EQ(report.find("topology of the surface")->status, CheckStatus::kFailed);
  EXPECT_EQ(report.surface_comparison->components, 2u);
}

TEST(SurfaceChecks, LargeTrianglesAreSampledWithin) {
  // The cube's faces bulge out of the octahedron between its corners.
  const SurfaceMesh cube = boundary_surface(test::cube_mesh(1, 2, {-1, -1, -1}));
  SurfaceMesh dented = boundary_surface(test::cube_mesh(8, 0.25, {-1, -1, -1}));
  for (Point3& p : dented.points) {
    if (p == Point3{0.25, 0.25, 1}) p.z = 0.5;
  }
  CheckOptions options;
  options.surface = &cube;
  const CheckReport report = check_mesh(dented, options);
  EXPECT_NEAR(report.surface_comparison->distances.mesh_to_surface_max_mm, 0.5, 1e-12);
  EXPECT_GT(report.surface_comparison->distances.surface_to_mesh_max_mm, 0.1);
}

}  // namespace
}  // namespace delvox
