#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "delvox/meshing/delsurf.h"
#include "delvox/volume/voxel_topology.h"
#include "mesh_expectations.h"
#include "support/shapes.h"

namespace delvox {
namespace {

struct Shape {
  const char* kind;
  double smallest_curvature_radius;  ///< mm
  std::vector<double> sizes;
};

struct Errors {
  std::vector<double> size, volume, area;
};

/// The slope of the least-squares line through (log size, log error).
double order_of(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const double n = static_cast<double>(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double log_size = std::log(sizes[i]), log_error = std::log(errors[i]);
    x += log_size;
    y += log_error;
    xx += log_size * log_size;
    xy += log_size * log_error;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

SurfaceMesh mesh_at(const Oracle& oracle, double size) {
  DelSurfOptions options;
  options.surface.size = size;
  RunReport report;
  SurfaceMesh mesh = delsurf(oracle, options, report);
  test::expect_finished(report);
  test::expect_closed_manifold(mesh);
  return mesh;
}

class Convergence : public testing::TestWithParam<Shape> {};

// In a 64 mm image: ball of radius 20; semi-axes 24, 17.6, 12.8; torus of radii 17.6 and 6.4.
INSTANTIATE_TEST_SUITE_P(Formulas, Convergence,
                         testing::Values(Shape{"sphere", 20, {7, 5, 3.5, 2.5, 1.75}},
                                         Shape{"ellipsoid", 12.8 * 12.8 / 24, {4, 2.8, 2, 1.4, 1}},
                                         Shape{"torus", 6.4, {3, 2.1, 1.5, 1.05}}),
                         [](const auto& info) { return std::string(info.param.kind); });

TEST_P(Convergence, VolumeAndAreaErrorsFallWithTheSquareOfTheSizeAndTheDistanceIsBoundedByIt) {
  const Shape& shape = GetParam();
  const PhantomOptions image = test::cubic_image(64);
  const PhantomTruth truth = phantom_truth(shape.kind, image);
  const auto oracle = test::implicit_phantom_oracle(shape.kind, image, 0.5);
  Errors errors;
  for (double size : shape.sizes) {
    const SurfaceMesh mesh = mesh_at(*oracle, size);
    EXPECT_EQ(test::topology_of(mesh).euler, *truth.euler) << size;
    EXPECT_EQ(test::topology_of(mesh).components, 1u) << size;
    errors.size.push_back(size);
    errors.volume.push_back(std::abs(test::enclosed_volume(mesh) / *truth.volume_mm3 - 1));
    errors.area.push_back(std::abs(test::area_of(mesh) / *truth.area_mm2 - 1));
    double farthest = 0;
    test::for_each_sample(mesh, 6, [&](const Point3& p) {
      // To first order in the distance, which is all that is needed this near to the surface.
      farthest = std::max(farthest, std::abs(truth.value(p)) / norm(truth.gradient(p)));
    });
    EXPECT_LT(farthest, size * size / shape.smallest_curvature_radius) << size;
  }
  EXPECT_GE(order_of(errors.size, errors.volume), 1.8);
  EXPECT_GE(order_of(errors.size, errors.area), 1.8);
}

TEST(ConvergenceThroughVoxels, TheSphereOfVoxelsIsApproachedWithTheSquareOfTheSize) {
  const PhantomOptions image = test::cubic_image(64);
  const Volume volume = make_phantom("sphere", image);
  const auto oracle = make_isosurface_oracle(volume, {0, false});
  // What the voxels hold, not the ball they were sampled from: that is off by a constant.
  const double voxel_volume = count_topology(volume, {0, false}).volume_mm3;
  const double radius = std::cbrt(3 * voxel_volume / (4 * std::numbers::pi));
  const double voxel_area = 4 * std::numbers::pi * radius * radius;
  EXPECT_NEAR(radius, 20, 0.02);
  Errors errors;
  for (double size : {7.0, 5.0, 3.5, 2.5}) {
    const SurfaceMesh mesh = mesh_at(*oracle, size);
    EXPECT_EQ(test::topology_of(mesh).euler, 2);
    errors.size.push_back(size);
    errors.volume.push_back(std::abs(test::enclosed_volume(mesh) / voxel_volume - 1));
    errors.area.push_back(std::abs(test::area_of(mesh) / voxel_area - 1));
    double farthest = 0;
    test::for_each_sample(mesh, 6, [&](const Point3& p) { farthest = std::max(farthest, std::abs(norm(p) - 20)); });
    EXPECT_LT(farthest, size * size / 20);
  }
  EXPECT_GE(order_of(errors.size, errors.volume), 1.8);
  EXPECT_GE(order_of(errors.size, errors.area), 1.8);
}

}  // namespace
}  // namespace delvox
