#include <gtest/gtest.h>

#include <cmath>

#include "check/triangle_tree.h"
#include "check/trilinear_field.h"
#include "delvox/check/check_mesh.h"
#include "support/test_meshes.h"
#include "support/test_volumes.h"

namespace delvox {
namespace {

using check::TrilinearField;
using test::ball;
using test::volume_of;

Affine3 oblique() {
  Affine3 affine;
  affine.rows = {{{0.6, -0.8, 0, 10}, {0.8, 0.6, 0, -5}, {0, 0, 1.5, 3}}};
  return affine;
}

constexpr Point3 kCenter{12.3, 11.9, 12.2};
constexpr double kRadius = 8;

Volume sphere_volume(const Affine3& affine = {}) {
  return volume_of({25, 25, 25}, [](double x, double y, double z) { return ball(x, y, z, kCenter, kRadius); }, affine);
}

// An icosphere in index space with every node put on the trilinear isosurface by bisection, then mapped to the world.
SurfaceMesh mesh_on_isosurface(const Volume& volume, int levels = 3) {
  SurfaceMesh mesh = test::icosphere(levels, 1);
  const auto g = [&](const Point3& p) {
    double sum = 0;
    const int i = static_cast<int>(p.x), j = static_cast<int>(p.y), k = static_cast<int>(p.z);
    for (int c = 0; c < 8; ++c) {
      sum += volume.value(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) * (c & 1 ? p.x - i : 1 - p.x + i) *
             (c & 2 ? p.y - j : 1 - p.y + j) * (c & 4 ? p.z - k : 1 - p.z + k);
    }
    return sum;
  };
  for (Point3& p : mesh.points) {
    double low = kRadius - 2, high = kRadius + 2;
    for (int step = 0; step < 60; ++step) {
      const double r = 0.5 * (low + high);
      (g(kCenter + r * p) > 0 ? low : high) = r;
    }
    p = volume.header().index_to_world(kCenter + low * p);
  }
  mesh.info.isovalue = 0;
  return mesh;
}

CheckOptions against(const Volume& volume) {
  CheckOptions options;
  options.volume = &volume;
  return options;
}

TEST(TrilinearField, IsExactForLinearFunctions) {
  const Volume ramp = volume_of({9, 8, 7}, [](double x, double y, double z) { return x + 2 * y - z; });
  const TrilinearField field(ramp, {5.0});
  EXPECT_NEAR(field.value({3.3, 2.1, 1.7}), 3.3 + 4.2 - 1.7 - 5, 1e-6);
  const Vector3 g = field.gradient({3.3, 2.1, 1.7});
  EXPECT_NEAR(distance(g, {1, 2, -1}), 0, 1e-6);
  EXPECT_NEAR(field.first_crossing({0.2, 1, 1}, {1, 0, 0}, 100).value(), 3.8, 1e-6);
  EXPECT_NEAR(field.first_crossing({7.9, 1, 1}, {-2, 0, 0}, 100).value(), 1.95, 1e-6);
  EXPECT_FALSE(field.first_crossing({0.2, 1, 1}, {1, 0, 0}, 3.7).has_value());
  EXPECT_DOUBLE_EQ(field.distance_outside({3, 3, 3}), 0);
  EXPECT_DOUBLE_EQ(field.distance_outside({-3, 3, 10}), std::hypot(2, 3));
}

TEST(TrilinearField, FindsCrossingsInPairsWithinOneVoxel) {
  // Along the cell's diagonal the function dips below the level and returns.
  const Volume cell = volume_of({2, 2, 2}, [](double x, double y, double z) {
    const double n = x + y + z;
    return n == 0 || n == 3 ? 1.0 : -0.5;
  });
  const TrilinearField field(cell, {0.0});
  const double t = field.first_crossing({0, 0, 0}, {1, 1, 1}, 1).value();
  EXPECT_GT(t, 0.1);
  EXPECT_LT(t, 0.5);
  EXPECT_NEAR(field.value({t, t, t}), 0, 1e-12);
  const double back = field.first_crossing({t + 1e-3, t + 1e-3, t + 1e-3}, {1, 1, 1}, 1).value();
  EXPECT_NEAR(t + 1e-3 + back, 1 - t, 1e-9);
}

TEST(TriangleTree, DistanceAgreesWithAllTriangles) {
  const SurfaceMesh mesh = test::icosphere(3, 2, {1, 2, 3});
  const check::TriangleTree tree(mesh.points, mesh.triangles);
  for (int s = 0; s < 200; ++s) {
    const Point3 p{1 + 3 * std::sin(s * 1.3), 2 + 3 * std::sin(s * 2.1), 3 + 3 * std::sin(s * 0.7)};
    double best = 1e30;
    for (const Triangle& t : mesh.triangles) {
      const Point3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
      best = std::min(best, check::squared_distance_to_triangle(p, a, b, c));
    }
    EXPECT_DOUBLE_EQ(tree.distance(p), std::sqrt(best));
    EXPECT_NEAR(tree.distance(p), std::abs(distance(p, {1, 2, 3}) - 2), 0.02);
  }
}

TEST(CheckAgainstVoxels, MeshOnTheIsosurfaceHolds) {
  for (const Affine3& affine : {Affine3{}, oblique()}) {
    const Volume volume = sphere_volume(affine);
    SurfaceMesh mesh = mesh_on_isosurface(volume);
    if (affine.determinant() < 0) mesh = test::inverted(mesh);
    mesh.info.promises.size = 2.5;
    mesh.info.promises.max_deviation = 0.5;
    CheckOptions options = against(volume);
    options.require_same_topology = true;
    const CheckReport report = check_mesh(mesh, options);
    EXPECT_TRUE(report.all_hold()) << to_text(report);
    EXPECT_LT(report.find("nodes on the isosurface")->measured, 1e-6);
    EXPECT_EQ(report.find("topology of the voxels")->status, CheckStatus::kPassed);
    ASSERT_TRUE(report.comparison.has_value());
    EXPECT_EQ(report.comparison->voxels.euler, 2);
    EXPECT_NEAR(report.comparison->volume_ratio, 1, 0.02);
    EXPECT_LT(report.comparison->distances.mesh_to_surface_max_mm, 0.35);
    EXPECT_GT(report.comparison->distances.mesh_to_surface_max_mm, 0.01);
    EXPECT_LT(report.comparison->distances.surface_to_mesh_max_mm, 0.35);
    EXPECT_LT(report.comparison->distances.surface_to_mesh_mean_mm, report.comparison->distances.surface_to_mesh_max_mm);
  }
}

TEST(CheckAgainstVoxels, NodeOffTheIsosurfaceIsNamed) {
  const Volume volume = sphere_volume();
  SurfaceMesh mesh = mesh_on_isosurface(volume);
  mesh.points[17] = mesh.points[17] + 0.001 * (mesh.points[17] - kCenter);
  const CheckReport report = check_mesh(mesh, against(volume));
  const Check* nodes = report.find("nodes on the isosurface");
  EXPECT_EQ(nodes->status, CheckStatus::kFailed);
  EXPECT_EQ(nodes->violations, 1u);
  EXPECT_NEAR(nodes->measured, 0.008, 0.002);
  EXPECT_EQ(nodes->where, mesh.points[17]);
}

TEST(CheckAgainstVoxels, CoarseFormatIsGivenItsRounding) {
  const Volume volume = sphere_volume();
  SurfaceMesh mesh = mesh_on_isosurface(volume);
  for (Point3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 1000) / 1000;
  }
  CheckOptions options = against(volume);
  EXPECT_FALSE(check_mesh(mesh, options).all_hold());
  options.coordinate_error = 5e-4 / 12;
  EXPECT_TRUE(check_mesh(mesh, options).all_hold()) << to_text(check_mesh(mesh, options));
}

TEST(CheckAgainstVoxels, ForeignMeshIsMeasuredButNotHeld) {
  const Volume volume = sphere_volume();
  SurfaceMesh mesh = test::icosphere(3, 7.5, kCenter);
  CheckOptions options = against(volume);
  options.isosurface = Isosurface{0.0};
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_TRUE(report.all_hold());
  EXPECT_NEAR(report.find("nodes on the isosurface")->measured, 0.5, 0.1);
  EXPECT_NEAR(report.comparison->distances.surface_to_mesh_max_mm, 0.55, 0.15);
  options.node_tolerance_voxels = 0.1;
  EXPECT_EQ(check_mesh(mesh, options).find("nodes on the isosurface")->status, CheckStatus::kFailed);
}

TEST(CheckAgainstVoxels, SurfaceBallsAreHeldToSizeAndDeviation) {
  const Volume volume = sphere_volume();
  const SurfaceMesh mesh = mesh_on_isosurface(volume, 2);
  const auto failed = [&](auto member, double bound) {
    CheckOptions options = against(volume);
    options.bounds = Promises{};
    (*options.bounds).*member = bound;
    return !check_mesh(mesh, options).all_hold();
  };
  CheckOptions options = against(volume);
  const CheckReport report = check_mesh(mesh, options);
  const double size = report.find("size")->measured, deviation = report.find("deviation")->measured;
  EXPECT_NEAR(deviation, size * size / (2 * kRadius), 0.15 * deviation);
  EXPECT_FALSE(failed(&Promises::size, size));
  EXPECT_TRUE(failed(&Promises::size, size * 0.999));
  EXPECT_FALSE(failed(&Promises::max_deviation, deviation));
  EXPECT_TRUE(failed(&Promises::max_deviation, deviation * 0.999));
}

TEST(CheckAgainstVoxels, MissingComponentIsNamed) {
  const Volume volume = volume_of({40, 25, 25}, [](double x, double y, double z) {
    return std::max(ball(x, y, z, kCenter, kRadius), ball(x, y, z, {32, 12, 12}, 4));
  });
  const SurfaceMesh mesh = mesh_on_isosurface(volume);
  CheckOptions options = against(volume);
  options.require_same_topology = true;
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_EQ(report.find("topology of the voxels")->status, CheckStatus::kFailed);
  EXPECT_GT(report.comparison->distances.surface_to_mesh_max_mm, 10);
}

TEST(CheckAgainstVoxels, RimMustLieOnTheImageBorder) {
  const Volume volume = volume_of({25, 25, 13}, [](double x, double y, double z) {
    return ball(x, y, z, kCenter, kRadius);
  });
  SurfaceMesh mesh = mesh_on_isosurface(sphere_volume(), 4);
  // As --border open does: triangles with a node in the padding go.
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.points[t[0]].z > 12 || mesh.points[t[1]].z > 12 || mesh.points[t[2]].z > 12;
  });
  mesh.info.open_border = true;
  CheckReport report = check_mesh(mesh, against(volume));
  EXPECT_EQ(report.find("rim on the image border")->status, CheckStatus::kPassed) << to_text(report);
  EXPECT_EQ(report.find("closed surface")->status, CheckStatus::kNotApplicable);
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return mesh.points[t[0]].z < 6; });
  report = check_mesh(mesh, against(volume));
  EXPECT_EQ(report.find("rim on the image border")->status, CheckStatus::kFailed);
}

TEST(CheckAgainstVoxels, CheapLevelLeavesTheVolumeAlone) {
  const Volume volume = sphere_volume();
  CheckOptions options = against(volume);
  options.level = CheckLevel::kCheap;
  EXPECT_FALSE(check_mesh(mesh_on_isosurface(volume), options).comparison.has_value());
}

}  // namespace
}  // namespace delvox
