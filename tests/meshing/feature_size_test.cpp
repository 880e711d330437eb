#include "delvox/meshing/feature_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/oracle/formula.h"
#include "delvox/oracle/polygon_oracle.h"
#include "support/random.h"
#include "support/shapes.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

const Box3 kBox{{-2, -2, -2}, {2, 2, 2}};

std::unique_ptr<SmoothOracle> formula(const std::string& text) {
  return make_formula_oracle(Formula(text), kBox, 0.03);
}

TEST(FeatureSize, IsTheLeastOfLengthsAndDistances) {
  test::Random random(2);
  std::vector<Point3> points;
  std::vector<double> lengths;
  for (int i = 0; i < 500; ++i) {
    points.push_back(random.in(kBox));
    lengths.push_back(random.unit());
  }
  const FeatureSize feature(points, lengths);
  for (int i = 0; i < 500; ++i) {
    const Point3 p = random.in(kBox), q = random.in(kBox);
    double least = Box3::kInfinity;
    for (std::size_t k = 0; k < points.size(); ++k) least = std::min(least, lengths[k] + distance(p, points[k]));
    EXPECT_EQ(feature(p), least);
    EXPECT_LE(std::abs(feature(p) - feature(q)), distance(p, q) * (1 + 1e-12));
  }
}

TEST(LocalFeatureSize, IsThatOfSpheresAndTori) {
  const auto sphere = formula("x^2+y^2+z^2-1");
  const FeatureSize of_sphere = local_feature_size(*sphere, 0.05);
  for (const Point3& p : sphere->seeds(0.2).points) EXPECT_NEAR(of_sphere(p), 1, 0.04);
  // The nearer of the circle in its middle and its axis.
  const auto torus = formula("(sqrt(x^2+y^2)-1)^2+z^2-0.36");
  const FeatureSize of_torus = local_feature_size(*torus, 0.05);
  double least = 1, most = 0;
  for (const Point3& p : torus->seeds(0.2).points) {
    const double truth = std::min(0.6, std::hypot(p.x, p.y));
    EXPECT_NEAR(of_torus(p), truth, 0.05) << p.x << " " << p.y << " " << p.z;
    least = std::min(least, truth);
    most = std::max(most, truth);
  }
  EXPECT_LT(least, 0.45);
  EXPECT_GT(most, 0.59);
}

TEST(LocalFeatureSize, SeesGapsAndWallsThatCurvatureDoesNot) {
  // Two balls of radius 0.7, a fifth apart.
  const auto balls = formula("min((x-0.8)^2+y^2+z^2-0.49, (x+0.8)^2+y^2+z^2-0.49)");
  const Point3 facing{0.1, 0, 0}, away{1.5, 0, 0};
  EXPECT_NEAR(local_feature_size(*balls, 0.04)(facing), 0.1, 0.02);
  EXPECT_NEAR(local_feature_size(*balls, 0.04)(away), 0.7, 0.05);
  EXPECT_NEAR(curvature_radius(*balls, 0.04)(facing), 0.7, 0.05);
}

TEST(CurvatureRadius, IsTheLeastOfTheTwo) {
  const auto torus = formula("(sqrt(x^2+y^2)-1)^2+z^2-0.36");
  const FeatureSize radius = curvature_radius(*torus, 0.04);
  EXPECT_NEAR(radius({0.4, 0, 0}), 0.4, 0.05);                                      // around the hole
  EXPECT_NEAR(radius({1.6, 0, 0}), 0.6, 0.05);                                      // around the tube
  const auto voxels = test::voxel_phantom_oracle("sphere", test::cubic_image(32));  // radius 10
  const FeatureSize of_voxels = curvature_radius(*voxels, 2);
  EXPECT_NEAR(of_voxels(voxels->seeds(3.0).points[0]), 10, 2);
}

TEST(Lipschitz, HoldsBackFieldsThatAreTooSteep) {
  const auto sphere = formula("x^2+y^2+z^2-1");
  const SizeField steep([](const Point3& p) { return p.x < 0 ? 0.05 : 0.8; }, 0.05, 0.8);
  const SizeField gentle = lipschitz(steep, *sphere, 0.02);
  for (const Point3& p : sphere->seeds(0.1).points) {
    EXPECT_LE(gentle(p), steep(p));
    EXPECT_GE(gentle(p), 0.05);
    if (p.x >= 0) {
      EXPECT_NEAR(gentle(p), std::min(0.8, 0.05 + std::sqrt(2 - 2 * std::sqrt(1 - p.x * p.x))), 0.04);
    }
  }
  EXPECT_TRUE(lipschitz(SizeField(0.3), *sphere, 0.1).constant());
}

TEST(Scaled, StaysWithinItsBounds) {
  const FeatureSize feature({{0, 0, 0}}, {1.0});
  const SizeField size = scaled(feature, 0.5, 0.6, 2);
  EXPECT_EQ(size({0, 0, 0}), 0.6);
  EXPECT_EQ(size({1, 0, 0}), 1);
  EXPECT_EQ(size({9, 0, 0}), 2);
  EXPECT_EQ(size.minimum(), 0.6);
  EXPECT_EQ(size.maximum(), 2);
}

TEST(LocalFeatureSize, OfACubeVanishesAtItsEdges) {
  const auto cube = make_polygon_oracle(boundary_surface(test::cube_mesh(1, 1)));
  const FeatureSize feature = local_feature_size(*cube, 0.05);
  EXPECT_NEAR(feature({0.5, 0.5, 0}), 0.5 / std::sqrt(2.0), 0.03);  // of the plane between two faces
  EXPECT_LT(feature({0.5, 0, 0}), 0.15);
}

}  // namespace
}  // namespace delvox
