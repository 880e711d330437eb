// load() with a surface keeps what lies near it only. Whatever is computed from that surface must stay the same.
#include <gtest/gtest.h>

#include "delvox/volume/phantom.h"
#include "delvox/volume/volume_source.h"
#include "delvox/volume/voxel_topology.h"
#include "oracle/brick_field.h"

namespace delvox {
namespace {

void expect_same_field(const BrickField& a, const BrickField& b) {
  ASSERT_EQ(a.brick_counts(), b.brick_counts());
  std::array<int, 3> brick;
  for (brick[2] = 0; brick[2] < a.brick_counts()[2]; ++brick[2]) {
    for (brick[1] = 0; brick[1] < a.brick_counts()[1]; ++brick[1]) {
      for (brick[0] = 0; brick[0] < a.brick_counts()[0]; ++brick[0]) {
        ASSERT_EQ(a.state(brick), b.state(brick));
        if (a.state(brick) != BrickField::State::kMixed) continue;
        ASSERT_TRUE(std::equal(a.block(brick), a.block(brick) + BrickField::kBlockSize, b.block(brick)));
      }
    }
  }
}

std::size_t differing_samples(const Volume& a, const Volume& b) {
  const std::vector<float> x = a.samples(), y = b.samples();
  std::size_t count = 0;
  for (std::size_t n = 0; n < x.size(); ++n) count += x[n] != y[n] ? 1 : 0;
  return count;
}

TEST(CollapsedVolume, GivesTheSameBricksRegionsAndFilteredBricks) {
  for (const char* kind : {"sphere", "shells", "border", "gyroid", "noisy-sphere", "ramp", "random", "touching-balls"}) {
    for (const std::array<int, 3>& dims : {std::array<int, 3>{64, 56, 48}, {61, 43, 50}, {9, 40, 3}}) {
      PhantomOptions options = phantom_defaults(kind);
      options.dims = dims;
      const VolumeSourcePtr source = phantom_source(kind, options);
      const Volume whole = load(*source);
      for (double shift : {0.0, 3.0, -3.0}) {
        for (bool below : {false, true}) {
          const Isosurface surface{phantom_truth(kind, options).isovalue + shift, below};
          SCOPED_TRACE(std::string(kind) + " " + std::to_string(dims[0]) + " " + std::to_string(surface.isovalue));
          const Volume near = load(*source, surface);
          EXPECT_EQ(near.min(), whole.min());
          EXPECT_EQ(near.max(), whole.max());
          const LevelSet level_set(surface);
          expect_same_field(BrickField(whole, level_set), BrickField(near, level_set));
          EXPECT_EQ(count_topology(whole, surface), count_topology(near, surface));
          EXPECT_EQ(count_topologies(*source, {surface})[0], count_topology(near, surface));
          const ComponentFilter filter{false, 20, true};
          const FilteredVolume a = filter_components(whole, surface, filter), b = filter_components(near, surface, filter);
          EXPECT_EQ(a.report.removed_mm3, b.report.removed_mm3);
          expect_same_field(BrickField(a.volume, level_set), BrickField(b.volume, level_set));
        }
      }
    }
  }
}

TEST(CollapsedVolume, FilteringLeavesTheVolumeItselfAlone) {
  const Volume volume = make_phantom("noisy-sphere");
  const std::vector<float> before = volume.samples();
  const Isosurface surface{phantom_truth("noisy-sphere", phantom_defaults("noisy-sphere")).isovalue, false};
  const FilteredVolume filtered = filter_components(volume, surface, {true, 0, false});
  EXPECT_GT(filtered.report.removed_components, 0u);
  EXPECT_EQ(volume.samples(), before);
  EXPECT_GT(differing_samples(volume, filtered.volume), 0u);
}

TEST(CollapsedVolume, KeepsFewSamplesOfALargeBall) {
  PhantomOptions options;
  options.dims = {128, 128, 128};
  const VolumeSourcePtr source = phantom_source("sphere", options);
  const Volume whole = load(*source), near = load(*source, Isosurface{0, false});
  // The surface of a ball of radius 40 within three blocks of eight voxels.
  const double kept = static_cast<double>(whole.voxel_count() - differing_samples(whole, near));
  EXPECT_LT(kept, 4 * 3.15 * 41 * 41 * 30);
}

}  // namespace
}  // namespace delvox
