#include "delvox/volume/write_volume.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cmath>

#include "delvox/volume/phantom.h"
#include "volume/volume_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

/// Samples with tiles, fractions, negatives and more slices than a slab.
Volume make_volume(const Affine3& affine, Frame frame, std::array<int, 3> dims = {13, 9, 19}) {
  VolumeHeader header;
  header.dims = dims;
  header.index_to_world = affine;
  header.frame = frame;
  std::vector<float> samples;
  for (int n = 0; n < dims[0] * dims[1] * dims[2]; ++n) {
    samples.push_back(n < dims[0] * dims[1] * 9 ? 0.0f : 0.1f * static_cast<float>(n) - 50.0f);
  }
  return Volume(header, samples);
}

Affine3 oblique() {
  const double c = std::cos(0.4), s = std::sin(0.4);
  Affine3 affine;
  affine.rows = {{{0.7 * c, -0.8 * s, 0, -12.3}, {0.7 * s, 0.8 * c, 0, 45.6}, {0, 0, -2.5, 7.89}}};
  return affine;
}

Affine3 straight() {
  Affine3 affine;
  affine.rows = {{{0.7, 0, 0, -12.3}, {0, 0.8, 0, 45.6}, {0, 0, 2.5, 7.89}}};
  return affine;
}

void expect_same(const Volume& actual, const Volume& expected, double tolerance) {
  EXPECT_EQ(actual.dims(), expected.dims());
  EXPECT_EQ(actual.samples(), expected.samples());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      EXPECT_NEAR(actual.header().index_to_world.rows[row][column], expected.header().index_to_world.rows[row][column],
                  tolerance);
    }
  }
}

TEST(WriteVolume, RoundTripsThroughVdbAndRawToTheLastBits) {
  const TempFolder folder;
  Affine3 sheared = oblique();
  sheared.rows[0][2] = 0.3;
  for (const Affine3& affine : {oblique(), straight(), sheared}) {
    for (Frame frame : {Frame::kRas, Frame::kLps, Frame::kUnknown}) {
      const Volume volume = make_volume(affine, frame);
      for (const std::string name : {"v.vdb", "v.json"}) {
        write_volume(volume, folder / name);
        const Volume back = read_volume(folder / name);
        // OpenVDB takes a scaling apart as map(1, 1, 1) - map(0, 0, 0), which rounds.
        expect_same(back, volume, name == "v.json" ? 0 : 1e-13);
        EXPECT_EQ(back.header().frame, frame);
        EXPECT_TRUE(back.header().warnings.empty());
      }
    }
  }
}

TEST(WriteVolume, RoundTripsThroughNiftiWithinItsFloatAffine) {
  const TempFolder folder;
  Affine3 sheared = oblique();
  sheared.rows[0][2] = 0.3;
  for (const Affine3& affine : {oblique(), straight(), sheared}) {
    for (Frame frame : {Frame::kRas, Frame::kUnknown}) {
      const Volume volume = make_volume(affine, frame);
      for (const std::string name : {"v.nii", "v.nii.gz"}) {
        write_volume(volume, folder / name);
        const Volume back = read_volume(folder / name);
        expect_same(back, volume, 1e-5);
        EXPECT_EQ(back.header().frame, Frame::kRas);
        EXPECT_TRUE(back.header().warnings.empty());
      }
    }
  }
}

TEST(WriteVolume, TurnsLpsIntoNiftisRas) {
  const TempFolder folder;
  const Volume volume = make_volume(oblique(), Frame::kLps);
  write_volume(volume, folder / "v.nii");
  const Point3 lps = volume.header().index_to_world({3, 2, 1});
  const Point3 ras = read_volume(folder / "v.nii").header().index_to_world({3, 2, 1});
  EXPECT_NEAR(ras.x, -lps.x, 1e-5);
  EXPECT_NEAR(ras.y, -lps.y, 1e-5);
  EXPECT_NEAR(ras.z, lps.z, 1e-5);
}

TEST(WriteVolume, WritesAQformThatSaysTheSameAsTheSform) {
  const TempFolder folder;
  // All 48 axis permutations and flips, each also turned: every branch of the quaternion, both handednesses.
  for (int permutation = 0; permutation < 6; ++permutation) {
    for (int flips = 0; flips < 8; ++flips) {
      for (double angle : {0.0, 0.4}) {
        int order[3] = {0, 1, 2};
        for (int n = 0; n < permutation; ++n) std::next_permutation(order, order + 3);
        Affine3 axes, turn;
        for (int n = 0; n < 3; ++n) {
          axes.rows[n] = {0, 0, 0, 5.0 * n};
          axes.rows[n][order[n]] = (flips >> n & 1 ? -1 : 1) * (1 + 0.5 * order[n]);
        }
        const double c = std::cos(angle), s = std::sin(angle);
        turn.rows = {{{c, -s, 0, 0}, {s, c, 0, 0}, {0, 0, 1, 0}}};
        const Volume volume = make_volume(compose(turn, axes), Frame::kRas, {4, 5, 6});
        write_volume(volume, folder / "v.nii");
        std::string bytes = read_file(folder / "v.nii");
        bytes.replace(254, 2, std::string(2, '\0'));  // no sform: qform alone must do
        expect_same(read_volume(write_file(folder / "q.nii", bytes)), volume, 2e-5);
      }
    }
  }
}

TEST(WriteVolume, WritesNifti2ForLongAxes) {
  const TempFolder folder;
  const Volume volume = make_volume(oblique(), Frame::kRas, {40000, 1, 2});
  write_volume(volume, folder / "v.nii");
  const Volume back = read_volume(folder / "v.nii");
  EXPECT_EQ(back.header().format, "NIfTI-2");
  expect_same(back, volume, 1e-14);
}

TEST(WriteVolume, RoundTripsThroughTiffIfAxesAreStraight) {
  const TempFolder folder;
  for (Frame frame : {Frame::kRas, Frame::kLps, Frame::kUnknown}) {
    const Volume volume = make_volume(straight(), frame);
    write_volume(volume, folder / "v.tif");
    const Volume back = read_volume(folder / "v.tif");
    expect_same(back, volume, 1e-12);
    EXPECT_EQ(back.header().frame, frame);
    EXPECT_TRUE(back.header().warnings.empty());
  }
}

TEST(WriteVolume, RefusesWhatAFormatCannotState) {
  const TempFolder folder;
  EXPECT_THROW(write_volume(make_volume(oblique(), Frame::kRas), folder / "v.tif"), OptionError);
  Affine3 mirrored = straight();
  mirrored.rows[0][0] = -0.7;
  EXPECT_THROW(write_volume(make_volume(mirrored, Frame::kRas), folder / "v.tif"), OptionError);
  EXPECT_THROW(write_volume(make_volume(straight(), Frame::kRas), folder / "v.mha"), OptionError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(WriteVolume, WritesTheSameBytesTwice) {
  const TempFolder folder;
  const Volume volume = make_volume(straight(), Frame::kRas);
  for (const std::string name : {"v.nii", "v.nii.gz", "v.tif", "v.json", "v.vdb"}) {
    write_volume(volume, folder / name);
    const std::string first = read_file(folder / name);
    write_volume(volume, folder / name);
    EXPECT_EQ(first, read_file(folder / name)) << name;
  }
}

TEST(WriteVolume, ThrowsIoErrorAndLeavesNothingBehindWhereItCannotWrite) {
  const TempFolder folder;
  const Volume volume = make_volume(straight(), Frame::kRas);
  for (const std::string name : {"v.nii", "v.nii.gz", "v.tif", "v.json", "v.vdb"}) {
    EXPECT_THROW(write_volume(volume, folder / "missing" / name), IoError) << name;
    fs::create_directory(folder / name);
    EXPECT_THROW(write_volume(volume, folder / name), IoError) << name;
    fs::remove(folder / name);
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(WriteVolume, NoticesAFullDisk) {
  const TempFolder folder;
  const Volume volume = make_volume(straight(), Frame::kRas);
  // A limit on file sizes fails as a full disk does, once its signal is ignored.
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  for (const std::string name : {"v.nii", "v.nii.gz", "v.tif", "v.json", "v.vdb"}) {
    const rlimit limit{2000, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_THROW(write_volume(volume, folder / name), IoError) << name;
    ::setrlimit(RLIMIT_FSIZE, &before);
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(WriteVolume, StreamsAPhantomOf16BitsToTiff) {
  const TempFolder folder;
  PhantomOptions options;
  options.dims = {40, 30, 19};
  options.uint16 = true;
  const VolumeSourcePtr phantom = phantom_source("sphere", options);
  write_volume(*phantom, folder / "stack.tif");
  const VolumeSourcePtr stack = open_volume(folder / "stack.tif");
  EXPECT_EQ(stack->header().sample_type, "uint16");
  EXPECT_EQ(stack->header().index_to_world.rows, phantom->header().index_to_world.rows);
  const std::vector<float> samples = load(*stack).samples();
  EXPECT_EQ(samples, make_phantom("sphere", options).samples());
  for (float sample : samples) ASSERT_TRUE(sample == std::round(sample) && sample >= 0 && sample <= 65535);
  EXPECT_EQ(phantom_truth("sphere", options).isovalue, 32767.5);
}

}  // namespace
}  // namespace delvox
