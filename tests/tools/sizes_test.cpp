#include "sizes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/volume/phantom.h"
#include "delvox/volume/write_volume.h"
#include "tools/run_delvox.h"

namespace delvox::tools {
namespace {

using test::TemporaryFolder;

TEST(ParseSize, TakesPositiveNumbersOnly) {
  EXPECT_EQ(parse_size("2.5", "--size", Frame::kRas).maximum(), 2.5);
  for (const char* text : {"", "0", "-1", "2mm", "nan", "1e999", "no_such_file.nii"}) {
    EXPECT_THROW(parse_size(text, "--size", Frame::kRas), OptionError) << text;
  }
}

TEST(ParseSize, AVolumeIsInterpolatedAndHeldConstantBeyondItsEdges) {
  VolumeHeader header;
  header.dims = {2, 1, 1};
  header.frame = Frame::kRas;
  header.index_to_world.rows[0] = {4, 0, 0, 10};
  TemporaryFolder folder;
  const std::string path = folder / "sizes.nii";
  write_volume(Volume(header, {1, 3}), path);
  const SizeField size = parse_size(path, "--size", Frame::kRas);
  EXPECT_NEAR(size({10, 0, 0}), 1, 1e-6);
  EXPECT_NEAR(size({12, 5, 0}), 2, 1e-6);
  EXPECT_NEAR(size({99, 0, 0}), 3, 1e-6);
  EXPECT_EQ(size.minimum(), 1);
  EXPECT_EQ(size.maximum(), 3);
  EXPECT_NEAR(parse_size(path, "--size", Frame::kLps)({-12, 5, 0}), 2, 1e-6);
}

TEST(DefaultSize, IsASixtiethOfTheOrganButNotBelowTheVoxels) {
  const Volume volume = make_phantom("sphere");  // 64 voxels of 1 mm
  const double isovalue = phantom_truth("sphere", phantom_defaults("sphere")).isovalue;
  EXPECT_NEAR(default_size(volume, {isovalue, false}), 1.5, 1e-9);
  EXPECT_THROW(default_size(volume, {1e9, false}), NothingToMesh);
}

}  // namespace
}  // namespace delvox::tools
