#include "oracle/voxel_seeds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "oracle/surface_crossings.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

Volume specks(int n, int gap, float peak) {
  VolumeHeader header;
  header.dims = {n, n, n};
  std::vector<float> samples(static_cast<std::size_t>(n) * n * n, 0.0f);
  for (int k = 1; k < n; k += gap) {
    for (int j = 1; j < n; j += gap) {
      for (int i = 1; i < n; i += gap) samples[(static_cast<std::size_t>(k) * n + j) * n + i] = peak;
    }
  }
  return Volume(header, samples);
}

struct Crossing {
  Point3 point;
  std::uint32_t component;
};

std::vector<Crossing> crossings_of(const BrickField& field) {
  const SurfaceComponents found = find_components(field, always_go_on);
  std::vector<Crossing> result;
  field.for_each_mixed_brick([&](const std::array<int, 3>& brick) {
    for_each_crossed_edge(field, brick, BrickEdges(field, brick), [&](const CrossedEdge& edge) {
      result.push_back({edge.point(field.level()), found.of_crossing[result.size()]});
    });
  });
  return result;
}

TEST(VoxelSeeds, EverySpeckGetsSeedsOnAllItsSixSides) {
  // Voxels that stick out alone: spans of a fifth, and of a thousandth, of a voxel to either side.
  for (float peak : {1.25f, 1.001f}) {
    const Volume volume = specks(18, 3, peak);
    const BrickField field(volume, LevelSet(Isosurface{1, false}));
    const Seeds seeds = voxel_seeds(field, Affine3{}, 10.0, always_go_on);
    EXPECT_EQ(seeds.components, 216u);
    std::set<std::array<int, 4>> sides;
    for (const Point3& p : seeds.points) {
      EXPECT_NEAR(field.value(p), 0, 1e-12);
      const Point3 voxel{std::round(p.x), std::round(p.y), std::round(p.z)};
      const Vector3 off = p - voxel;
      int axis = 0;
      for (int other : {1, 2}) {
        if (std::abs(off[other]) > std::abs(off[axis])) axis = other;
      }
      sides.insert({int(voxel.x), int(voxel.y), int(voxel.z), 2 * axis + (off[axis] > 0)});
    }
    EXPECT_EQ(sides.size(), 216u * 6) << peak;
  }
}

TEST(VoxelSeeds, LieOffTheGridLinesSoThatTheyAreNotCospherical) {
  const Volume volume = make_phantom("sphere", test::cubic_image(24));
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  const Seeds seeds = voxel_seeds(field, Affine3{}, 1.5, always_go_on);
  int on_lines = 0;
  for (const Point3& p : seeds.points) {
    int integers = 0;
    for (int axis = 0; axis < 3; ++axis) integers += p[axis] == std::round(p[axis]);
    on_lines += integers >= 2;
  }
  EXPECT_LT(on_lines, static_cast<int>(seeds.points.size()) / 20);
}

TEST(VoxelSeeds, AreThoseThereAreWhenToldToStop) {
  const Volume volume = make_phantom("sphere", test::cubic_image(24));
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  const Seeds all = voxel_seeds(field, Affine3{}, 0.5, always_go_on);
  std::size_t asked = 0, in_all = 0;
  voxel_seeds(field, Affine3{}, 0.5, [&] { return ++in_all != 0; });
  const Seeds some = voxel_seeds(field, Affine3{}, 0.5, [&] { return ++asked <= in_all / 2; });
  ASSERT_FALSE(some.points.empty());
  ASSERT_LT(some.points.size(), all.points.size());
  for (std::size_t i = 0; i < some.points.size(); ++i) EXPECT_EQ(some.points[i], all.points[i]) << i;
  EXPECT_EQ(asked, in_all / 2 + 1);  // and not asked again
}

TEST(VoxelSeeds, EveryComponentOfNoiseHasSeedsNearItsCrossings) {
  PhantomOptions image = test::cubic_image(20);
  image.noise = 1;
  const Volume volume = make_phantom("noisy-sphere", image);
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  const std::vector<Crossing> crossings = crossings_of(field);
  const Seeds seeds = voxel_seeds(field, Affine3{}, 3.0, always_go_on);
  std::vector<int> count(seeds.components, 0), seeded(seeds.components, 0);
  for (const Crossing& c : crossings) ++count.at(c.component);
  for (const Point3& p : seeds.points) {
    const Crossing* nearest = nullptr;
    for (const Crossing& c : crossings) {
      if (nearest == nullptr || squared_distance(c.point, p) < squared_distance(nearest->point, p)) nearest = &c;
    }
    ++seeded[nearest->component];
  }
  for (std::size_t c = 0; c < count.size(); ++c) EXPECT_GE(seeded[c], std::min(4, count[c])) << c;
}

}  // namespace
}  // namespace delvox
