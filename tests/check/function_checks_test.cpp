#include "check/function_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/test_meshes.h"

namespace delvox {
namespace {

const char* const kNodes = "nodes on the surface of the function";
const char* const kTopology = "topology of the function, sampled 128 times along its box";

ImplicitFunction sphere_of_radius(double r) {
  return {[r](const Point3& p) { return squared_norm(p) - r * r; }, [](const Point3& p) { return 2 * p; },
          {{-2, -2, -2}, {2, 2, 2}}};
}

CheckReport check_against(const ImplicitFunction& function, const SurfaceMesh& mesh, const Affine3& to_world = {}) {
  CheckOptions options;
  options.function = &function;
  options.function_to_world = to_world;
  options.require_same_topology = true;
  return check_mesh(mesh, options);
}

TEST(FunctionChecks, NodesOfASphereLieOnItAndItsTrianglesAsFarInsideAsTheySag) {
  const SurfaceMesh mesh = test::icosphere(4);
  const CheckReport report = check_against(sphere_of_radius(1), mesh);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  EXPECT_LT(report.find(kNodes)->measured, 1e-12);
  double longest = 0;
  for (const Triangle& t : mesh.triangles) longest = std::max(longest, distance(mesh.points[t[0]], mesh.points[t[1]]));
  const double sag = longest * longest / 6;  // of an equilateral triangle's centre, nearly
  const SurfaceDistances& d = report.surface_comparison->distances;
  EXPECT_NEAR(d.mesh_to_surface_max_mm, sag, 0.15 * sag);
  EXPECT_LT(d.surface_to_mesh_max_mm, 1.1 * sag);
  EXPECT_GT(d.surface_to_mesh_max_mm, 0.8 * sag);
  EXPECT_LT(d.mesh_to_surface_mean_mm, d.mesh_to_surface_max_mm);
}

TEST(FunctionChecks, ANodeBesideTheSurfaceIsFoundAndSaidWhere) {
  SurfaceMesh mesh = test::icosphere(3);
  mesh.points[7] = 1.001 * mesh.points[7];
  const CheckReport report = check_against(sphere_of_radius(1), mesh);
  const Check* nodes = report.find(kNodes);
  EXPECT_EQ(nodes->status, CheckStatus::kFailed);
  EXPECT_EQ(nodes->violations, 1u);
  EXPECT_EQ(*nodes->where, mesh.points[7]);
  EXPECT_NEAR(nodes->measured, 0.001, 1e-6);
}

TEST(FunctionChecks, WhatTheMeshDoesNotHaveShowsInTopologyAndDistance) {
  const ImplicitFunction two{[](const Point3& p) {
                               return std::min(squared_norm(p) - 1, squared_norm(p - Point3{3, 0, 0}) - 0.25);
                             },
                             [](const Point3& p) {
                               const Point3 q = p - Point3{3, 0, 0};
                               return squared_norm(p) - 1 < squared_norm(q) - 0.25 ? 2 * p : 2 * q;
                             },
                             {{-2, -2, -2}, {4, 2, 2}}};
  const CheckReport report = check_against(two, test::icosphere(3));
  EXPECT_EQ(report.find(kNodes)->status, CheckStatus::kPassed);
  EXPECT_EQ(report.find(kTopology)->status, CheckStatus::kFailed);
  EXPECT_EQ(report.surface_comparison->components, 2u);
  EXPECT_EQ(report.surface_comparison->euler, 4);
  EXPECT_NEAR(report.surface_comparison->distances.surface_to_mesh_max_mm, 2.5, 0.01);
}

TEST(FunctionChecks, TheFunctionMayLieElsewhereAndBeMirrored) {
  const ImplicitFunction ellipsoid{
      [](const Point3& p) { return p.x * p.x + 4 * p.y * p.y + p.z * p.z - 1; },
      [](const Point3& p) { return Vector3{2 * p.x, 8 * p.y, 2 * p.z}; },
      {{-2, -2, -2}, {2, 2, 2}}};
  const Affine3 to_world{{{{0, 1, 0, 10}, {-1, 0, 0, 20}, {0, 0, -1, 30}}}};
  SurfaceMesh mesh = test::icosphere(4);
  for (Point3& p : mesh.points) p = to_world({p.x, 0.5 * p.y, p.z});
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(check_against(ellipsoid, mesh, to_world).all_hold()) << to_text(check_against(ellipsoid, mesh, to_world));
  EXPECT_FALSE(check_against(ellipsoid, mesh).all_hold());
}

TEST(FunctionChecks, WhereAFunctionIsUndefinedIsOutside) {
  const ImplicitFunction half{[](const Point3& p) { return squared_norm(p) - std::sqrt(2 - p.x); },
                              [](const Point3& p) { return 2 * p + Vector3{0.5 / std::sqrt(2 - p.x), 0, 0}; },
                              {{-4, -4, -4}, {4, 4, 4}}};
  const CheckReport report = check_against(half, test::icosphere(2));
  EXPECT_EQ(report.surface_comparison->components, 1u);
  EXPECT_EQ(report.surface_comparison->euler, 2);
  EXPECT_EQ(report.find(kNodes)->status, CheckStatus::kFailed);
}

}  // namespace
}  // namespace delvox
