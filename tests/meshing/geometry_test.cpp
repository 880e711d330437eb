#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "delvox/meshing/delsurf.h"
#include "delvox/volume/preprocess.h"
#include "mesh_expectations.h"
#include "support/mesh_distance.h"
#include "support/shapes.h"

// Where meshes lie in the world: spacing, direction, half voxels, flips.

namespace delvox {
namespace {

SurfaceMesh mesh_at(const Volume& volume, double isovalue, double size) {
  const auto oracle = make_isosurface_oracle(volume, {isovalue, false});
  DelSurfOptions options;
  options.surface.size = size;
  RunReport report;
  SurfaceMesh mesh = delsurf(*oracle, options, report);
  test::expect_finished(report);
  test::expect_closed_manifold(mesh);
  return mesh;
}

/// Trilinear value and gradient at voxel coordinates, from the samples themselves.
struct Interpolated {
  double value = 0;
  Vector3 gradient;
};
Interpolated interpolate(const Volume& volume, const Point3& u) {
  Interpolated result;
  int low[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(static_cast<int>(std::floor(u[axis])), volume.dims()[axis] - 2);
  }
  for (int corner = 0; corner < 8; ++corner) {
    double weight[3], slope[3];
    int at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int up = corner >> axis & 1;
      at[axis] = low[axis] + up;
      weight[axis] = up ? u[axis] - low[axis] : low[axis] + 1 - u[axis];
      slope[axis] = up ? 1 : -1;
    }
    const double sample = volume.value(at[0], at[1], at[2]);
    result.value += weight[0] * weight[1] * weight[2] * sample;
    result.gradient =
        result.gradient + sample * Vector3{slope[0] * weight[1] * weight[2], weight[0] * slope[1] * weight[2],
                                           weight[0] * weight[1] * slope[2]};
  }
  return result;
}

/// The centre of the sphere that fits points best, by linear least squares on |p|^2 = 2 c.p + d.
Point3 fitted_center(const std::vector<Point3>& points) {
  Point3 mean;
  for (const Point3& p : points) mean = mean + (1.0 / static_cast<double>(points.size())) * p;
  Affine3 normal;  // 3x3 part: sum of q q^T over centred points
  normal.rows = {};
  Vector3 right;
  double mean_square = 0;
  for (const Point3& p : points) mean_square += squared_distance(p, mean) / static_cast<double>(points.size());
  for (const Point3& p : points) {
    const Vector3 q = p - mean;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) normal.rows[row][column] += q[row] * q[column];
    }
    right = right + (0.5 * (squared_norm(q) - mean_square)) * q;
  }
  return mean + normal.inverse().linear(right);
}

TEST(Geometry, NodesOfObliqueImagesSatisfyTheTrilinearEquationInVoxelCoordinates) {
  const PhantomOptions image = test::oblique_image();
  for (const char* kind : {"oblique-sphere", "torus", "ellipsoid"}) {
    const Volume volume = make_phantom(kind, image);
    const SurfaceMesh mesh = mesh_at(volume, 0, 1.2);
    const Affine3 to_index = volume.header().index_to_world.inverse();
    for (const Point3& p : mesh.points) {
      const Interpolated h = interpolate(volume, to_index(p));
      ASSERT_LE(std::abs(h.value), 1e-5 * norm(h.gradient)) << kind;
    }
  }
}

TEST(Geometry, NodesOfAPlaneRampLieOnThePlane) {
  PhantomOptions straight = test::cubic_image(18), oblique = test::oblique_image();
  oblique.dims = {20, 17, 12};
  straight.center = {100, -50, 25};
  for (const PhantomOptions& image : {straight, oblique}) {
    const Volume volume = make_phantom("ramp", image);
    const SurfaceMesh mesh = mesh_at(volume, 0, 1.5);
    const Affine3 to_index = volume.header().index_to_world.inverse();
    const Vector3 normal = (1.0 / 7) * Vector3{2, 3, 6};
    const double voxel = std::min({image.spacing.x, image.spacing.y, image.spacing.z});
    int on_plane = 0;
    for (const Point3& p : mesh.points) {
      const Point3 u = to_index(p);
      bool in_image = true;  // beyond the last voxel centres the padding bends and closes it
      for (int axis = 0; axis < 3; ++axis) in_image &= u[axis] >= 0 && u[axis] <= image.dims[axis] - 1;
      if (!in_image) continue;
      ++on_plane;
      ASSERT_LE(std::abs(dot(normal, p - image.center)), 1e-6 * voxel);
    }
    EXPECT_GT(on_plane, 50);
  }
}

TEST(Geometry, TheFittedCentreOfASphereIsItsCentre) {
  for (const PhantomOptions& image : {test::cubic_image(32), test::oblique_image()}) {
    for (const char* kind : {"sphere", "oblique-sphere"}) {
      const PhantomTruth truth = phantom_truth(kind, image);
      const SurfaceMesh mesh = mesh_at(make_phantom(kind, image), 0, 1.5);
      const double voxel = std::min({image.spacing.x, image.spacing.y, image.spacing.z});
      EXPECT_LT(distance(fitted_center(mesh.points), *truth.center), 0.02 * voxel) << kind;
    }
  }
}

class GeometryOfTurnedVolumes : public testing::TestWithParam<const char*> {
 protected:
  void expect_same_in_world(const Volume& turned, const char* how) const {
    const SurfaceMesh mesh = mesh_at(turned, 0, kSize);
    EXPECT_EQ(test::topology_of(mesh).components, test::topology_of(reference_).components) << how;
    EXPECT_EQ(test::topology_of(mesh).euler, test::topology_of(reference_).euler) << how;
    EXPECT_NEAR(test::enclosed_volume(mesh) / test::enclosed_volume(reference_), 1, 1e-3) << how;
    EXPECT_LT(test::two_sided_distance(mesh, reference_), kSize * kSize / smallest_radius()) << how;
  }
  double smallest_radius() const {
    const PhantomOptions image = test::oblique_image();
    const double half_extent = 0.5 * image.dims[2] * image.spacing.z;  // the shortest edge of the image
    return std::string(GetParam()) == "torus" ? 0.2 * half_extent : 0.4 * 0.4 / 0.75 * half_extent;
  }

  static constexpr double kSize = 0.9;
  Volume volume_ = make_phantom(GetParam(), test::oblique_image());
  SurfaceMesh reference_ = mesh_at(volume_, 0, kSize);
};

INSTANTIATE_TEST_SUITE_P(Phantoms, GeometryOfTurnedVolumes, testing::Values("ellipsoid", "torus"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(GeometryOfTurnedVolumes, FlipsAndPermutationsGiveTheSameBodyInTheWorld) {
  expect_same_in_world(flip_axis(volume_, 0), "flipped along i");
  expect_same_in_world(flip_axis(volume_, 1), "flipped along j");
  expect_same_in_world(flip_axis(volume_, 2), "flipped along k");
  for (const std::array<int, 3>& order : {std::array{1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}) {
    expect_same_in_world(permute_axes(volume_, order), "permuted");
  }
  expect_same_in_world(flip_axis(permute_axes(flip_axis(volume_, 2), {2, 0, 1}), 1), "flipped, permuted, flipped");
}

}  // namespace
}  // namespace delvox
