#include "delvox/oracle/isosurface_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

Volume constant_volume(const std::array<int, 3>& dims, float value) {
  VolumeHeader header;
  header.dims = dims;
  return Volume(header, std::vector<float>(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2], value));
}

TEST(IsosurfaceOracle, LabelAtAGridPointIsItsSampleComparedWithTheIsovalueEvenInTies) {
  const Volume volume = make_phantom("random");
  for (bool below : {false, true}) {
    const auto oracle = make_isosurface_oracle(volume, {2, below});
    const auto dims = volume.dims();
    int ties = 0;
    for (int k = 0; k < dims[2]; ++k) {
      for (int j = 0; j < dims[1]; ++j) {
        for (int i = 0; i < dims[0]; ++i) {
          const float h = volume.value(i, j, k);
          ties += h == 2;
          const bool inside = below ? h <= 2 : h >= 2;
          ASSERT_EQ(oracle->label(volume.header().index_to_world({double(i), double(j), double(k)})), inside ? 1 : 0);
        }
      }
    }
    EXPECT_GT(ties, 5000);
  }
}

TEST(IsosurfaceOracle, CrossingsBetweenNeighbouringTiedSamplesAreWhereTheyShouldBe) {
  const Volume volume = make_phantom("random");
  const auto oracle = make_isosurface_oracle(volume, {2, false});
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 20; ++i) {
        const double g = volume.value(i, j, k), h = volume.value(i + 1, j, k);
        const Point3 a = volume.header().index_to_world({double(i), double(j), double(k)});
        const Point3 b = a + Vector3{1, 0, 0};
        const auto found = oracle->intersect_all(a, b);
        ASSERT_EQ(found.size(), (g >= 2) != (h >= 2) ? 1u : 0u) << g << " " << h;
        if (found.empty()) continue;
        EXPECT_NEAR(found[0].x, a.x + (2 - g) / (h - g), 1e-6);
        EXPECT_EQ(found[0].y, a.y);
        EXPECT_LT(distance(oracle->intersect(a, b), found[0]), 1e-12);
      }
    }
  }
}

TEST(IsosurfaceOracle, PlateausAtTheIsovalueLieWhollyInside) {
  const auto oracle = make_isosurface_oracle(constant_volume({6, 5, 4}, 3), {3, false});
  test::Random random(1);
  for (int n = 0; n < 1000; ++n) EXPECT_EQ(oracle->label(random.in({{0, 0, 0}, {5, 4, 3}})), 1);
  EXPECT_THROW(make_isosurface_oracle(constant_volume({6, 5, 4}, 3), {3.0001, false}), NothingToMesh);
  EXPECT_THROW(make_isosurface_oracle(constant_volume({6, 5, 4}, 3), {2.9999, true}), NothingToMesh);
}

TEST(IsosurfaceOracle, AnImageThatIsInsideEverywhereClosesHalfAVoxelOutsideItsSamples) {
  for (const std::array<int, 3>& dims : {std::array{1, 1, 1}, {8, 7, 6}, {9, 17, 8}}) {
    const auto oracle = make_isosurface_oracle(constant_volume(dims, 100), {40, false});
    const Point3 middle{0.5 * (dims[0] - 1), 0.5 * (dims[1] - 1), 0.5 * (dims[2] - 1)};
    for (int axis = 0; axis < 3; ++axis) {
      for (double sign : {-1.0, 1.0}) {
        Point3 outer = middle;
        outer[axis] += sign * 1000;
        const Point3 p = oracle->intersect(middle, outer);
        EXPECT_NEAR(p[axis], middle[axis] + sign * (0.5 * (dims[axis] - 1) + 0.5), 1e-9);
        EXPECT_EQ(oracle->intersect_all(middle, outer).size(), 1u);
      }
    }
    const Box3 bounds = oracle->bounds();
    EXPECT_EQ(bounds.min, (Point3{-1, -1, -1}));
    EXPECT_EQ(bounds.max, (Point3{double(dims[0]), double(dims[1]), double(dims[2])}));
  }
}

TEST(IsosurfaceOracle, AnOrganCutByTheBorderClosesHalfAVoxelOutside) {
  const PhantomOptions image = test::cubic_image(24);
  const auto oracle = test::voxel_phantom_oracle("border", image);
  const Point3 center = *phantom_truth("border", image).center;
  for (double y : {-2.0, -0.3, 0.0, 1.7}) {
    const Point3 from = center + Vector3{0, y, 0.4};
    const Point3 p = oracle->intersect(from, from + Vector3{100, 0, 0});
    EXPECT_NEAR(p.x, 11.5 + 0.5, 1e-9);
  }
}

TEST(IsosurfaceOracle, WorldPositionsFollowTheAffineExactly) {
  // The same samples under two affines: crossings must correspond under the map between the images.
  const Volume plain = make_phantom("torus", test::cubic_image(24));
  VolumeHeader header = plain.header();
  header.index_to_world.rows = {{{0.1, -0.7, 0.3, 100}, {-0.8, 0.2, 0.1, -50}, {0.2, 0.3, 1.5, 7}}};
  const Volume oblique(header, plain.samples());
  const auto a = make_isosurface_oracle(plain, {0, false}), b = make_isosurface_oracle(oblique, {0, false});
  const Affine3 map = compose(header.index_to_world, plain.header().index_to_world.inverse());
  test::Random random(2);
  int found = 0;
  for (int n = 0; n < 1000; ++n) {
    const Point3 p = random.in(a->bounds()), q = random.in(a->bounds());
    const auto crossings_a = a->intersect_all(p, q), crossings_b = b->intersect_all(map(p), map(q));
    ASSERT_EQ(crossings_a.size(), crossings_b.size());
    for (std::size_t i = 0; i < crossings_a.size(); ++i) {
      EXPECT_LT(distance(map(crossings_a[i]), crossings_b[i]), 1e-9);
      const Vector3 gradient = a->gradient(crossings_a[i]);
      EXPECT_LT(distance(map.linear_transposed(b->gradient(crossings_b[i])), gradient), 1e-6);
      ++found;
    }
  }
  EXPECT_GT(found, 200);
}

/// Label changes along a segment, by sampling.
std::size_t sampled_changes(const Oracle& oracle, const Point3& a, const Point3& b, int samples) {
  std::size_t changes = 0;
  for (int i = 0; i < samples; ++i) {
    const double s = static_cast<double>(i) / samples, t = static_cast<double>(i + 1) / samples;
    changes += oracle.label(a + s * (b - a)) != oracle.label(a + t * (b - a));
  }
  return changes;
}

TEST(IsosurfaceOracle, LinesAlongGridLinesPlanesAndDiagonalsThroughGridVerticesCrossAsSampled) {
  PhantomOptions image = test::cubic_image(17);
  image.noise = 0.7;
  image.center = {8, 8, 8};  // world = index
  const auto oracle = make_isosurface_oracle(make_phantom("noisy-sphere", image), {0, false});
  test::Random random(3);
  const auto lattice = [&] {
    return Point3{double(random.below(17)), double(random.below(17)), double(random.below(17))};
  };
  std::size_t total = 0;
  for (int n = 0; n < 600; ++n) {
    const Point3 from = lattice();
    Point3 to = from;
    switch (n % 4) {
      case 0: to[random.below(3)] = random.below(17); break;                   // along a grid line
      case 1: to = from + double(random.below(8)) * Vector3{1, 1, 1}; break;   // through grid vertices
      case 2: to = from + double(random.below(8)) * Vector3{1, -1, 0}; break;  // through grid edges, in a plane
      default: to = lattice();
    }
    if (from == to) continue;
    const auto found = oracle->intersect_all(from, to);
    constexpr int kSamples = 4000;
    const std::size_t sampled = sampled_changes(*oracle, from, to, kSamples);
    std::size_t unseen = 0;  // pairs closer than the sampling step
    for (std::size_t i = 1; i < found.size(); ++i) {
      if (distance(found[i - 1], found[i]) < distance(from, to) / kSamples) unseen += 2;
      EXPECT_LT(distance(from, found[i - 1]), distance(from, found[i]));
    }
    EXPECT_GE(found.size(), sampled);
    EXPECT_LE(found.size(), sampled + unseen);
    for (const Point3& p : found) EXPECT_LE(std::abs(oracle->value(p)), 1e-12);
    total += found.size();
  }
  EXPECT_GT(total, 200u);
}

TEST(IsosurfaceOracle, ACellCanBeCrossedThreeTimesByOneLine) {
  // Along the diagonal this cell's trilinear function is a cubic with three roots.
  VolumeHeader header;
  header.dims = {2, 2, 2};
  const Volume volume(header, {-0.3f, 1, 1, -1, 1, -1, -1, 0.3f});
  const auto oracle = make_isosurface_oracle(volume, {0, false});
  const Point3 a{0, 0, 0}, b{1, 1, 1};
  const auto found = oracle->intersect_all(a, b);
  EXPECT_EQ(found.size(), sampled_changes(*oracle, a, b, 10000));
  EXPECT_EQ(found.size(), 3u);
  for (const Point3& p : found) EXPECT_NEAR(oracle->value(p), 0, 1e-14);
}

TEST(IsosurfaceOracle, LargeValuesAndLargeOffsetsKeepCrossingsOnTheSurface) {
  PhantomOptions image = test::cubic_image(20);
  const Volume base = make_phantom("sphere", image);
  for (const auto& [scale, offset] : {std::pair{1e6, 0.0}, {1.0, 3e4}, {1e-6, 0.0}, {1e-30, 0.0}, {1e30, 0.0}}) {
    std::vector<float> samples = base.samples();
    for (float& s : samples) s = static_cast<float>(scale * s + offset);
    const auto oracle = make_isosurface_oracle(Volume(base.header(), samples), {offset, false});
    test::Random random(4);
    for (int n = 0; n < 200; ++n) {
      const Point3 p = oracle->intersect({0, 0, 0}, 100.0 * random.direction());
      EXPECT_LE(std::abs(oracle->value(p)), 1e-9 * norm(oracle->gradient(p))) << scale << " " << offset;
      EXPECT_NEAR(norm(p), 6.25, 0.1) << scale << " " << offset;
    }
  }
}

TEST(IsosurfaceOracle, TellsTheRangeWhenTheIsovalueIsOutsideIt) {
  try {
    make_isosurface_oracle(make_phantom("random"), {7, false});
    FAIL();
  } catch (const NothingToMesh& error) {
    EXPECT_NE(std::string(error.what()).find("3.0"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace delvox
