#include "delvox/volume/voxel_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/brute_force_topology.h"
#include "support/test_volumes.h"

namespace delvox {
namespace {

using test::ball;
using test::volume_of;

struct PaddedSamples {
  std::array<int, 3> n;  // samples per axis
  std::vector<float> values;
  double at(double x, double y, double z) const {
    const int i = std::min(static_cast<int>(x), n[0] - 2), j = std::min(static_cast<int>(y), n[1] - 2),
              k = std::min(static_cast<int>(z), n[2] - 2);
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      const int di = c & 1, dj = c >> 1 & 1, dk = c >> 2;
      sum += values[(static_cast<std::size_t>(k + dk) * n[1] + j + dj) * n[0] + i + di] * (di ? x - i : 1 - x + i) *
             (dj ? y - j : 1 - y + j) * (dk ? z - k : 1 - z + k);
    }
    return sum;
  }
};

PaddedSamples padded(const Volume& volume, const LevelSet& level_set) {
  PaddedSamples result;
  for (int axis = 0; axis < 3; ++axis) result.n[axis] = volume.dims()[axis] + 2;
  result.values.resize(static_cast<std::size_t>(result.n[0]) * result.n[1] * result.n[2]);
  copy_padded_block(volume, level_set, {-1, -1, -1}, result.n, result.values.data());
  return result;
}

bool agrees_at(const Volume& volume, const Isosurface& surface, int refinement, const VoxelTopology& exact) {
  const LevelSet level_set(surface);
  const PaddedSamples samples = padded(volume, level_set);
  const double h = 1.0 / refinement;
  test::BruteForceTopology brute(
      {(samples.n[0] - 1) * refinement, (samples.n[1] - 1) * refinement, (samples.n[2] - 1) * refinement},
      [&](int i, int j, int k) { return samples.at(i * h, j * h, k * h) - level_set.level; });
  return 2 * brute.euler() == exact.euler &&
         brute.inside_components() == static_cast<int>(exact.inside_components) &&
         brute.outside_components() == static_cast<int>(exact.cavities) + 1;
}

void expect_brute_force_agrees(const Volume& volume, const Isosurface& surface) {
  const VoxelTopology exact = count_topology(volume, surface);
  EXPECT_EQ(exact.surface_components, exact.inside_components + exact.cavities);
  for (int refinement : {6, 12, 24, 48}) {
    if (agrees_at(volume, surface, refinement, exact)) return;
  }
  std::string text;
  for (float x : volume.samples()) text += std::to_string(x) + " ";
  ADD_FAILURE() << "euler " << exact.euler << " inside " << exact.inside_components << " cavities " << exact.cavities
                << " of " << text;
}

Volume noise(std::array<int, 3> dims, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return volume_of(dims, [&](double, double, double) { return normal(random); });
}

Volume integers(std::array<int, 3> dims, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> integer(0, 3);
  return volume_of(dims, [&](double, double, double) { return integer(random); });
}

TEST(VoxelTopology, NoiseAgreesWithBruteForce) {
  for (unsigned seed = 0; seed < 40; ++seed) expect_brute_force_agrees(noise({3, 3, 3}, seed), {0.0});
  for (unsigned seed = 0; seed < 6; ++seed) expect_brute_force_agrees(noise({6, 5, 4}, seed), {0.2});
}

TEST(VoxelTopology, IntegersAgreeWithBruteForce) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    expect_brute_force_agrees(integers({4, 3, 3}, seed), {1.93});
    expect_brute_force_agrees(integers({3, 3, 4}, seed), {1.03, true});
  }
}

TEST(VoxelTopology, TiesCountAsInside) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Volume volume = integers({20, 20, 20}, seed);
    VoxelTopology at_two = count_topology(volume, {2.0}), below_two = count_topology(volume, {1.9999});
    EXPECT_NEAR(at_two.volume_mm3, below_two.volume_mm3, 5);
    at_two.volume_mm3 = below_two.volume_mm3 = 0;
    EXPECT_EQ(at_two, below_two);
  }
}

TEST(VoxelTopology, DoesNotDependOnTheOrderOfTheAxes) {
  const std::array<int, 3> n{14, 17, 11};
  const Volume volume = integers(n, 5), real = noise(n, 6);
  for (const Volume* v : {&volume, &real}) {
    const double iso = v == &volume ? 2.0 : 0.1;
    const std::vector<float> s = v->samples();
    const auto at = [&](double i, double j, double k) {
      return s[static_cast<std::size_t>((k * n[1] + j) * n[0] + i)];
    };
    const VoxelTopology reference = count_topology(*v, {iso});
    const VoxelTopology turned[] = {
        count_topology(volume_of({n[1], n[2], n[0]}, [&](double j, double k, double i) { return at(i, j, k); }), {iso}),
        count_topology(volume_of({n[2], n[0], n[1]}, [&](double k, double i, double j) { return at(i, j, k); }), {iso}),
        count_topology(volume_of(n, [&](double i, double j, double k) { return at(n[0] - 1 - i, j, n[2] - 1 - k); }),
                       {iso})};
    for (VoxelTopology t : turned) {
      EXPECT_NEAR(t.volume_mm3, reference.volume_mm3, 1e-2 * reference.volume_mm3);
      t.volume_mm3 = reference.volume_mm3;
      EXPECT_EQ(t, reference);
    }
  }
}

TEST(VoxelTopology, SphereIsASphereWithItsVolume) {
  const Volume volume = volume_of({32, 32, 32}, [](double x, double y, double z) {
    return ball(x, y, z, {15.3, 15.1, 15.7}, 10);
  });
  const VoxelTopology t = count_topology(volume, {0.0});
  EXPECT_EQ(t.surface_components, 1u);
  EXPECT_EQ(t.cavities, 0u);
  EXPECT_EQ(t.euler, 2);
  EXPECT_NEAR(t.volume_mm3, 4.0 / 3 * std::numbers::pi * 1000, 0.006 * 4189);
}

TEST(VoxelTopology, TorusHasEulerNumberZero) {
  const Volume volume = volume_of({40, 40, 16}, [](double x, double y, double z) {
    return 4 - std::hypot(std::hypot(x - 19.3, y - 19.6) - 12, z - 7.4);
  });
  EXPECT_EQ(count_topology(volume, {0.0}).euler, 0);
  EXPECT_EQ(count_topology(volume, {0.0}).surface_components, 1u);
}

TEST(VoxelTopology, NestedShellsFormATree) {
  Affine3 affine;
  affine.rows = {{{2, 0, 0, 5}, {0, 0, 1, 0}, {0, 0.5, 0, 1}}};
  const Volume volume = volume_of({40, 40, 40}, [](double x, double y, double z) {
    const double r = distance({x, y, z}, {19.5, 19.5, 19.5});
    return std::max(std::min(16 - r, r - 10), 5 - r);
  }, affine);
  const VoxelRegions found = list_regions(volume, {0.0});
  EXPECT_EQ(found.topology.inside_components, 2u);
  EXPECT_EQ(found.topology.cavities, 1u);
  EXPECT_EQ(found.topology.surface_components, 3u);
  EXPECT_EQ(found.topology.euler, 6);
  ASSERT_EQ(found.regions.size(), 4u);
  EXPECT_EQ(found.regions[1].parent, 0u);
  EXPECT_EQ(found.regions[2].parent, 3u);
  EXPECT_EQ(found.regions[3].parent, 1u);
  const double sphere = 4.0 / 3 * std::numbers::pi;
  EXPECT_NEAR(found.regions[1].volume_mm3, sphere * (4096 - 1000), 30);
  EXPECT_NEAR(found.regions[2].volume_mm3, sphere * 125, 12);
  EXPECT_NEAR(found.regions[3].volume_mm3, sphere * (1000 - 125), 24);
  EXPECT_EQ(found.regions[1].low, (std::array<int, 3>{4, 4, 4}));
  EXPECT_EQ(found.regions[1].high, (std::array<int, 3>{35, 35, 35}));
}

TEST(VoxelTopology, ImageBorderClosesWhatItCuts) {
  const Volume full = volume_of({5, 6, 7}, [](double, double, double) { return 1.0; });
  const VoxelTopology t = count_topology(full, {0.5});
  EXPECT_EQ(t.euler, 2);
  EXPECT_EQ(t.surface_components, 1u);
  EXPECT_NEAR(t.volume_mm3, 5 * 6 * 7, 8);
  EXPECT_EQ(count_topology(full, {2.0}).surface_components, 0u);
  EXPECT_EQ(count_topology(volume_of({1, 1, 1}, [](double, double, double) { return 1.0; }), {0.5}).euler, 2);
}

TEST(VoxelTopology, SlabsOfAnyDepthGiveTheSame) {
  // Deeper than one batch of slices: many of them, of few samples.
  const Volume deep = integers({5, 4, 300}, 9);
  const std::vector<float> s = deep.samples();
  const Volume flat = volume_of({300, 4, 5}, [&](double k, double j, double i) {
    return s[static_cast<std::size_t>((k * 4 + j) * 5 + i)];
  });
  VoxelTopology a = count_topology(deep, {2.0}), b = count_topology(flat, {2.0});
  EXPECT_NEAR(a.volume_mm3, b.volume_mm3, 10);
  a.volume_mm3 = b.volume_mm3 = 0;
  EXPECT_EQ(a, b);
}

Volume big_small_and_hollow() {
  return volume_of({40, 30, 30}, [](double x, double y, double z) {
    const double big = std::min(ball(x, y, z, {13, 14, 14}, 10), -ball(x, y, z, {13, 14, 14}, 4.2));
    return std::max({big, ball(x, y, z, {13, 14, 14}, 1.7), ball(x, y, z, {32, 14, 14}, 4),
                     ball(x, y, z, {32, 25, 25}, 1.5)});
  });
}

TEST(FilterComponents, NothingToDoSharesTheSamples) {
  const Volume volume = big_small_and_hollow();
  const FilteredVolume same = filter_components(volume, {0.0}, {});
  EXPECT_EQ(&same.volume.impl(), &volume.impl());
  EXPECT_EQ(same.report.kept_components, 4u);
}

TEST(FilterComponents, SpecksGoAndAllElseStays) {
  const Volume volume = big_small_and_hollow();
  const FilteredVolume filtered = filter_components(volume, {0.0}, {.min_component_mm3 = 60});
  EXPECT_EQ(filtered.report.removed_components, 2u);
  EXPECT_EQ(filtered.report.kept_components, 2u);
  EXPECT_EQ(filtered.report.filled_cavities, 0u);
  EXPECT_NEAR(filtered.report.removed_mm3, 4.0 / 3 * std::numbers::pi * (1.7 * 1.7 * 1.7 + 1.5 * 1.5 * 1.5), 8);
  const VoxelTopology t = count_topology(filtered.volume, {0.0});
  EXPECT_EQ(t.inside_components, 2u);
  EXPECT_EQ(t.cavities, 1u);
  const std::vector<float> before = volume.samples(), after = filtered.volume.samples();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_TRUE(after[i] == before[i] || (before[i] >= 0 && after[i] < 0)) << before[i] << " became " << after[i];
  }
}

TEST(FilterComponents, LargestOnlyKeepsItsCavity) {
  const FilteredVolume filtered = filter_components(big_small_and_hollow(), {0.0}, {.largest_only = true});
  const VoxelTopology t = count_topology(filtered.volume, {0.0});
  EXPECT_EQ(t.inside_components, 1u);
  EXPECT_EQ(t.cavities, 1u);
  EXPECT_EQ(filtered.report.removed_components, 3u);
}

TEST(FilterComponents, FilledCavitySwallowsWhatFloatsInIt) {
  const FilteredVolume filtered = filter_components(big_small_and_hollow(), {0.0}, {.fill_cavities = true});
  const VoxelTopology t = count_topology(filtered.volume, {0.0});
  EXPECT_EQ(t.inside_components, 3u);
  EXPECT_EQ(filtered.report.kept_components, 3u);
  EXPECT_EQ(t.cavities, 0u);
  EXPECT_EQ(t.euler, 6);
  // Removed specks inside filled cavities become inside as well, not new cavities.
  const FilteredVolume both =
      filter_components(big_small_and_hollow(), {0.0}, {.largest_only = true, .fill_cavities = true});
  EXPECT_EQ(count_topology(both.volume, {0.0}).euler, 2);
}

TEST(FilterComponents, WorksBelowTheIsovalueToo) {
  const Volume volume = big_small_and_hollow();
  std::vector<float> negated = volume.samples();
  for (float& x : negated) x = -x;
  const Volume below(volume.header(), negated);
  const FilteredVolume filtered = filter_components(below, {0.0, true}, {.min_component_mm3 = 60});
  EXPECT_EQ(filtered.report.removed_components, 2u);
  EXPECT_EQ(count_topology(filtered.volume, {0.0, true}).inside_components, 2u);
}

TEST(FilterComponents, InNoiseTheKeptComponentsStayTheSame) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Volume volume = seed % 2 ? noise({24, 24, 24}, seed) : integers({24, 24, 24}, seed);
    const Isosurface surface{seed % 2 ? 0.7 : 3.0};
    const VoxelRegions before = list_regions(volume, surface);
    const FilteredVolume filtered = filter_components(volume, surface, {.min_component_mm3 = 5});
    const VoxelRegions after = list_regions(filtered.volume, surface);
    EXPECT_EQ(after.topology.inside_components, filtered.report.kept_components);
    EXPECT_GT(filtered.report.removed_components, 10u);
    std::vector<std::size_t> kept;
    for (const VoxelRegion& region : before.regions) {
      if (region.inside && region.volume_mm3 >= 5) kept.push_back(region.samples);
    }
    std::vector<std::size_t> found;
    for (const VoxelRegion& region : after.regions) {
      if (region.inside) found.push_back(region.samples);
    }
    std::sort(kept.begin(), kept.end());
    std::sort(found.begin(), found.end());
    if (before.topology.cavities == after.topology.cavities) {
      EXPECT_EQ(kept, found);
    }
  }
}

}  // namespace
}  // namespace delvox
