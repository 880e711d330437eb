#include "oracle/voxel_landmarks.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "delvox/volume/voxel_topology.h"
#include "support/shapes.h"

namespace delvox {
namespace {

PhantomOptions noisy_image() {
  PhantomOptions image = test::cubic_image(14);
  image.noise = 1;
  return image;
}

bool everywhere(const Point3&) {
  return true;
}

TEST(VoxelLandmarks, LinksStayOnOneSideOfTheSurface) {
  const Volume volume = make_phantom("noisy-sphere", noisy_image());
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  const Landmarks landmarks = voxel_landmarks(field, everywhere, always_go_on);
  ASSERT_FALSE(landmarks.links.empty());
  for (const auto& [a, b] : landmarks.links) {
    const Point3 &p = landmarks.points[a], &q = landmarks.points[b];
    for (int step = 0; step <= 8; ++step) {
      ASSERT_EQ(field.inside(p + (step / 8.0) * (q - p)), field.inside(p));
    }
  }
}

/// Landmarks with each inside class counted; samples of pure bricks have none, so only images of one brick will do.
TEST(VoxelLandmarks, LinksJoinTheInsideIntoItsComponents) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    PhantomOptions image = test::cubic_image(7);  // with its padding exactly one brick
    image.noise = 1;
    image.seed = seed;
    const Volume volume = make_phantom("noisy-sphere", image);
    const BrickField field(volume, LevelSet(Isosurface{0, false}));
    const Landmarks landmarks = voxel_landmarks(field, everywhere, always_go_on);
    std::vector<std::size_t> parent(landmarks.points.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    for (const auto& [a, b] : landmarks.links) parent[root(a)] = root(b);
    std::set<std::size_t> inside;
    for (std::size_t i = 0; i < parent.size(); ++i) {
      if (field.inside(landmarks.points[i])) inside.insert(root(i));
    }
    EXPECT_EQ(inside.size(), count_topology(volume, {0, false}).inside_components) << seed;
  }
}

TEST(VoxelLandmarks, AreNoneWhenToldToStop) {
  const Volume volume = make_phantom("noisy-sphere", noisy_image());
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  int bricks = 0;
  EXPECT_TRUE(voxel_landmarks(field, everywhere, [&] { return ++bricks < 3; }).points.empty());
  EXPECT_EQ(bricks, 3);
}

TEST(VoxelLandmarks, AreAskedOfTheOracleOnlyWhereTheMeshIsFinerThanAVoxel) {
  const auto oracle = make_isosurface_oracle(make_phantom("noisy-sphere", noisy_image()), {0, false});
  EXPECT_TRUE(oracle->landmarks(1.01).points.empty());
  const Landmarks all = oracle->landmarks(0.5);
  const Landmarks half = oracle->landmarks({[](const Point3& p) { return p.x < 0 ? 0.5 : 2.0; }, 0.5, 2.0});
  EXPECT_FALSE(half.points.empty());
  EXPECT_LT(half.points.size(), all.points.size());
  for (const Point3& p : half.points) EXPECT_LT(p.x, 0);
  for (const auto& [a, b] : half.links) {
    ASSERT_LT(a, half.points.size());
    ASSERT_LT(b, half.points.size());
    EXPECT_EQ(oracle->label(half.points[a]), oracle->label(half.points[b]));
  }
}

}  // namespace
}  // namespace delvox
