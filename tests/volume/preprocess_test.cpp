#include "delvox/volume/preprocess.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "delvox/core/errors.h"
#include "delvox/volume/histogram.h"
#include "delvox/volume/phantom.h"

namespace delvox {
namespace {

PhantomOptions oblique(std::array<int, 3> dims) {
  PhantomOptions options = phantom_defaults("oblique-sphere");
  options.dims = dims;
  return options;
}

/// A grid without rotation, its first voxel at `origin`.
Volume plain_volume(std::array<int, 3> dims, const Vector3& spacing, const std::vector<float>& samples,
                    const Point3& origin = {}) {
  VolumeHeader header;
  header.dims = dims;
  for (int axis = 0; axis < 3; ++axis) {
    header.index_to_world.rows[axis][axis] = spacing[axis];
    header.index_to_world.rows[axis][3] = origin[axis];
  }
  return Volume(header, samples);
}

std::size_t voxels(std::array<int, 3> dims) { return static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]; }

Volume impulse(std::array<int, 3> dims, const Vector3& spacing) {
  std::vector<float> samples(voxels(dims), 0);
  samples[(static_cast<std::size_t>(dims[2] / 2) * dims[1] + dims[1] / 2) * dims[0] + dims[0] / 2] = 1000;
  return plain_volume(dims, spacing, samples);
}

template <typename Visit>
void for_each_voxel(const Volume& volume, Visit visit) {
  const std::vector<float> samples = volume.samples();
  std::size_t next = 0;
  for (int k = 0; k < volume.dims()[2]; ++k) {
    for (int j = 0; j < volume.dims()[1]; ++j) {
      for (int i = 0; i < volume.dims()[0]; ++i) visit(std::array<int, 3>{i, j, k}, samples[next++]);
    }
  }
}

Point3 world_of(const Volume& volume, const std::array<int, 3>& index) {
  return volume.header().index_to_world({1.0 * index[0], 1.0 * index[1], 1.0 * index[2]});
}

/// Every sample is what the phantom's function says at the sample's world position.
void expect_true_to_world(const Volume& volume, const PhantomTruth& truth, double tolerance, int margin = 0) {
  std::size_t seen = 0;
  double worst = 0;
  for_each_voxel(volume, [&](const std::array<int, 3>& index, float sample) {
    for (int axis = 0; axis < 3; ++axis) {
      if (index[axis] < margin || index[axis] >= volume.dims()[axis] - margin) return;
    }
    ++seen;
    worst = std::max(worst, std::abs(sample - truth.value(world_of(volume, index))));
  });
  EXPECT_GT(seen, 0u);
  EXPECT_LE(worst, tolerance);
}

TEST(Crop, KeepsEverySampleAtItsWorldPosition) {
  const PhantomOptions options = oblique({20, 24, 18});
  const Volume whole = make_phantom("ramp", options);
  const Volume part = crop(whole, {{3, 5, 7}, {11, 6, 18}});
  EXPECT_EQ(part.dims(), (std::array<int, 3>{8, 1, 11}));
  EXPECT_EQ(part.header().frame, Frame::kRas);
  for_each_voxel(part, [&](const std::array<int, 3>& index, float sample) {
    const std::array<int, 3> old{index[0] + 3, index[1] + 5, index[2] + 7};
    ASSERT_EQ(sample, whole.value(old[0], old[1], old[2]));
    ASSERT_LT(distance(world_of(part, index), world_of(whole, old)), 1e-12);
  });
  expect_true_to_world(part, phantom_truth("ramp", options), 1e-4);
}

TEST(Crop, ClipsToTheImageAndRefusesWhatIsEmpty) {
  const Volume volume = impulse({4, 5, 6}, {1, 1, 1});
  EXPECT_EQ(crop(volume, {{-3, 0, 2}, {99, 5, 9}}).dims(), (std::array<int, 3>{4, 5, 4}));
  for (const IndexBox& box : {IndexBox{{2, 0, 0}, {2, 5, 6}}, IndexBox{{4, 0, 0}, {9, 5, 6}},
                              IndexBox{{0, 0, 0}, {4, 5, 0}}, IndexBox{{0, 3, 0}, {4, 1, 6}}}) {
    EXPECT_THROW(crop(volume, box), NothingToMesh);
  }
}

TEST(Crop, WorldBoxTakesTheVoxelsWhoseCentersItHolds) {
  // Centers at 10, 10.5, 11, ... along x; 20, 22, ... along y; -5, -4, ... along z.
  const Volume volume = plain_volume({10, 10, 10}, {0.5, 2, 1}, std::vector<float>(1000, 0), {10, 20, -5});
  const IndexBox box = index_box(volume.header(), {{10.5, 20.1, -100}, {11.99, 25.9, -3.5}});
  EXPECT_EQ(box, (IndexBox{{1, 1, 0}, {4, 3, 2}}));
  EXPECT_THROW(crop(volume, index_box(volume.header(), {{10.1, 20, -5}, {10.4, 30, 5}})), NothingToMesh);
  EXPECT_THROW(crop(volume, index_box(volume.header(), {{100, 20, -5}, {110, 30, 5}})), NothingToMesh);
  EXPECT_THROW(crop(volume, index_box(volume.header(), Box3{})), NothingToMesh);
}

TEST(Crop, WorldBoxOnAFlippedObliqueImageHoldsEveryCenterInside) {
  const Volume volume = flip_axis(make_phantom("sphere", oblique({20, 24, 18})), 1);
  const Point3 middle = volume.header().index_to_world({9, 11, 8});
  const Box3 world{middle - Vector3{3, 2, 4}, middle + Vector3{2, 3, 1}};
  const IndexBox box = index_box(volume.header(), world);
  std::array<int, 3> low{99, 99, 99}, high{-1, -1, -1};
  for_each_voxel(volume, [&](const std::array<int, 3>& index, float) {
    if (!world.contains(world_of(volume, index))) return;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(index[axis], box.begin[axis]);
      EXPECT_LT(index[axis], box.end[axis]);
      low[axis] = std::min(low[axis], index[axis]);
      high[axis] = std::max(high[axis], index[axis]);
    }
  });
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(low[axis] - box.begin[axis], 2) << "the box is loose";
    EXPECT_LE(box.end[axis] - 1 - high[axis], 2) << "the box is loose";
  }
}

TEST(ParseCrop, ReadsVoxelsAndMillimetres) {
  const Volume volume = plain_volume({10, 20, 30}, {2, 1, 1}, std::vector<float>(6000, 0), {100, 0, 0});
  EXPECT_EQ(parse_crop(volume.header(), "1:4,2:20,0:30"), (IndexBox{{1, 2, 0}, {4, 20, 30}}));
  EXPECT_EQ(parse_crop(volume.header(), "3:,:7,:"), (IndexBox{{3, 0, 0}, {10, 7, 30}}));
  EXPECT_EQ(parse_crop(volume.header(), "-5:400,0:20,0:30"), (IndexBox{{0, 0, 0}, {10, 20, 30}}));
  EXPECT_EQ(parse_crop(volume.header(), "102:106,0.5:7.5,:mm"), (IndexBox{{1, 1, 0}, {4, 8, 30}}));
  EXPECT_EQ(parse_crop(volume.header(), ":,:,:mm"), (IndexBox{{0, 0, 0}, {10, 20, 30}}));
  EXPECT_THROW(crop(volume, parse_crop(volume.header(), "5:5,:,:")), NothingToMesh);
  EXPECT_THROW(crop(volume, parse_crop(volume.header(), "106:102,:,:mm")), NothingToMesh);
}

TEST(ParseCrop, RefusesWhatDoesNotParseAndSaysWhatToWrite) {
  const Volume volume = impulse({4, 5, 6}, {1, 1, 1});
  for (const char* text : {"", "1:2", "1:2,3:4", "1:2,3:4,5:6,7:8", "1-2,3:4,5:6", "a:2,3:4,5:6", "1.5:2,3:4,5:6",
                           "1:2,3:4,5:6cm", "1:2:3,3:4,5:6", "nan:2,3:4,5:6mm", "inf:2,3:4,5:6mm",
                           "1:99999999999,3:4,5:6", "mm"}) {
    try {
      parse_crop(volume.header(), text);
      ADD_FAILURE() << "accepted '" << text << "'";
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find("write x0:x1,y0:y1,z0:z1"), std::string::npos);
    }
  }
}

TEST(Smooth, LeavesConstantsAlone) {
  const std::vector<float> samples(voxels({9, 8, 7}), 0.1f);
  EXPECT_EQ(smooth(plain_volume({9, 8, 7}, {1, 0.5, 2}, samples), {1.3}).samples(), samples);
}

TEST(Smooth, LeavesTheInteriorOfARampAlone) {
  const PhantomOptions options = oblique({40, 36, 24});
  const Volume result = smooth(make_phantom("ramp", options), {1.1});
  EXPECT_EQ(result.header().index_to_world, make_phantom("ramp", options).header().index_to_world);
  expect_true_to_world(result, phantom_truth("ramp", options), 1e-4, 7);
}

TEST(Smooth, KeepsTheSumAndIsSymmetric) {
  const Volume result = smooth(impulse({31, 31, 31}, {1, 1, 1}), {1.5});
  const auto samples = result.samples();
  EXPECT_NEAR(std::accumulate(samples.begin(), samples.end(), 0.0), 1000, 1e-3);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(flip_axis(result, axis).samples(), samples);
}

TEST(Smooth, SpreadsByTheSameMillimetresAlongEveryAxis) {
  const Volume result = smooth(impulse({61, 41, 21}, {0.5, 0.8, 1.2}), {2.0});
  Vector3 moment{};
  double total = 0;
  for_each_voxel(result, [&](const std::array<int, 3>& index, float sample) {
    const Vector3 offset = world_of(result, index) - world_of(result, {30, 20, 10});
    for (int axis = 0; axis < 3; ++axis) moment[axis] += sample * offset[axis] * offset[axis];
    total += sample;
  });
  // Cutting at 4 sigma takes 0.1 % off the variance.
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(moment[axis] / total), 2.0, 0.005) << axis;
}

TEST(Smooth, EqualsTheDirectConvolutionInThreeDimensions) {
  PhantomOptions options = phantom_defaults("random");
  options.dims = {13, 11, 9};
  options.spacing = {0.6, 1.0, 1.7};
  const Volume volume = make_phantom("random", options);
  const std::vector<float> samples = volume.samples();
  const double sigma = 0.8;
  std::array<int, 3> radius;
  for (int axis = 0; axis < 3; ++axis) radius[axis] = static_cast<int>(4 * sigma / options.spacing[axis] + 0.5);
  const auto clamped = [&](int n, int axis) { return std::clamp(n, 0, options.dims[axis] - 1); };
  double worst = 0;
  for_each_voxel(smooth(volume, {sigma}), [&](const std::array<int, 3>& at, float smoothed) {
    double sum = 0, weights = 0;
    for (int c = -radius[2]; c <= radius[2]; ++c) {
      for (int b = -radius[1]; b <= radius[1]; ++b) {
        for (int a = -radius[0]; a <= radius[0]; ++a) {
          const Vector3 mm{a * options.spacing.x, b * options.spacing.y, c * options.spacing.z};
          const double weight = std::exp(-squared_norm(mm) / (2 * sigma * sigma));
          const int i = clamped(at[0] + a, 0), j = clamped(at[1] + b, 1), k = clamped(at[2] + c, 2);
          sum += weight * samples[(static_cast<std::size_t>(k) * options.dims[1] + j) * options.dims[0] + i];
          weights += weight;
        }
      }
    }
    worst = std::max(worst, std::abs(smoothed - sum / weights));
  });
  EXPECT_LT(worst, 1e-6);
}

TEST(Smooth, CommutesWithFlipsBitForBit) {
  const Volume volume = make_phantom("noisy-sphere", oblique({20, 18, 16}));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(smooth(flip_axis(volume, axis), {1.0}).samples(), flip_axis(smooth(volume, {1.0}), axis).samples());
  }
}

TEST(Smooth, TakesThinImagesAndRefusesSenselessSigmas) {
  const Volume slice = impulse({9, 9, 1}, {1, 1, 5});
  EXPECT_NEAR(smooth(slice, {1.0}).value(4, 4, 0), 1000 / (2 * 3.14159265), 0.5);
  EXPECT_EQ(smooth(slice, {0.0}).samples(), slice.samples());
  EXPECT_NO_THROW(smooth(slice, {9.0}));
  for (double sigma : {-1.0, 9.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(smooth(slice, {sigma}), OptionError) << sigma;
  }
}

TEST(Resample, IsExactOnALinearRampInTheInterior) {
  const PhantomOptions options = oblique({40, 36, 24});
  const PhantomTruth truth = phantom_truth("ramp", options);
  const Volume volume = make_phantom("ramp", options);
  expect_true_to_world(resample(volume, {0.5}), truth, 1e-4, 2);
  expect_true_to_world(resample(volume, {1.0}), truth, 1e-4, 4);
  expect_true_to_world(resample(volume, {2.3}), truth, 1e-4, 4);
}

TEST(Resample, CoversTheFieldOfViewAndKeepsItsMiddle) {
  const PhantomOptions options = oblique({40, 36, 24});
  const Volume volume = make_phantom("sphere", options);
  for (double mm : {0.45, 0.9, 1.6, 3.3}) {
    const Volume result = resample(volume, {mm});
    Point3 middle;
    for (int axis = 0; axis < 3; ++axis) {
      const double old_extent = options.dims[axis] * options.spacing[axis], extent = result.dims()[axis] * mm;
      EXPECT_GE(extent, old_extent - 1e-4);
      EXPECT_LT(extent, old_extent + mm);
      EXPECT_NEAR(result.header().spacing()[axis], mm, 1e-12);
      EXPECT_LT(distance((1 / mm) * result.header().index_to_world.column(axis), options.direction[axis]), 1e-12);
      middle[axis] = 0.5 * (result.dims()[axis] - 1);
    }
    EXPECT_LT(distance(result.header().index_to_world(middle), options.center), 1e-10);
  }
}

TEST(Resample, DoesNotAddAVoxelForRounding) {
  const Volume volume = impulse({64, 64, 64}, {0.1, 0.1, 0.1});
  EXPECT_EQ(resample(volume, {0.4}).dims(), (std::array<int, 3>{16, 16, 16}));
  EXPECT_EQ(resample(volume, {0.3}).dims(), (std::array<int, 3>{22, 22, 22}));
  EXPECT_EQ(resample(volume, {50}).dims(), (std::array<int, 3>{1, 1, 1}));
}

TEST(Resample, AtItsOwnSpacingChangesNothing) {
  const Volume volume = make_phantom("random");
  const Volume result = resample(volume, {1.0});
  EXPECT_EQ(result.samples(), volume.samples());
  EXPECT_EQ(result.header().index_to_world, volume.header().index_to_world);
}

TEST(Resample, SmoothsAwayWhatTheCoarserGridCannotHold) {
  std::vector<float> stripes(voxels({64, 8, 8}));
  for (std::size_t n = 0; n < stripes.size(); ++n) stripes[n] = n / 2 % 2 ? 1.0f : -1.0f;  // period 4 voxels along x
  const Volume volume = plain_volume({64, 8, 8}, {1, 1, 1}, stripes);
  const auto amplitude = [](const Volume& v) {
    double largest = 0;
    for (int i = 3; i < v.dims()[0] - 3; ++i) largest = std::max(largest, std::abs(1.0 * v.value(i, 1, 1)));
    return largest;
  };
  EXPECT_GT(amplitude(resample(volume, {4.1, false})), 0.85);
  EXPECT_LT(amplitude(resample(volume, {4.1, true})), 0.1);
}

TEST(Resample, RefusesSenselessSpacings) {
  const Volume volume = impulse({9, 9, 9}, {1, 1, 1});
  for (double mm : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e-3, 1e-300}) {
    EXPECT_THROW(resample(volume, {mm}), OptionError) << mm;
  }
}

TEST(Reorder, FlipsAndPermutationsKeepWorldValues) {
  PhantomOptions options = oblique({12, 15, 10});
  const Volume volume = make_phantom("ellipsoid", options);
  const PhantomTruth truth = phantom_truth("ellipsoid", options);
  for (int axis = 0; axis < 3; ++axis) {
    const Volume flipped = flip_axis(volume, axis);
    EXPECT_LT(flipped.header().index_to_world.determinant(), 0);
    EXPECT_NE(flipped.samples(), volume.samples());
    expect_true_to_world(flipped, truth, 1e-5);
    EXPECT_EQ(flip_axis(flipped, axis).samples(), volume.samples());
  }
  for (const std::array<int, 3>& order : {std::array<int, 3>{1, 2, 0}, {2, 1, 0}, {0, 2, 1}, {2, 0, 1}, {1, 0, 2}}) {
    const Volume permuted = permute_axes(volume, order);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(permuted.dims()[axis], options.dims[order[axis]]);
    expect_true_to_world(permuted, truth, 1e-5);
  }
  EXPECT_EQ(permute_axes(volume, {0, 1, 2}).samples(), volume.samples());
}

TEST(Preprocess, GivesTheSameBytesOnOneThread) {
  const Volume volume = make_phantom("noisy-sphere");
  const auto run = [&] {
    const Volume result = resample(smooth(volume, {1.2}), {1.7});
    std::vector<double> answer = SampleStatistics(result.samples()).otsu_isovalues(3);
    for (float sample : result.samples()) answer.push_back(sample);
    return answer;
  };
  const auto parallel = run();
  std::vector<double> serial;
  tbb::task_arena(1).execute([&] { serial = run(); });
  EXPECT_EQ(parallel, serial);
}

}  // namespace
}  // namespace delvox
