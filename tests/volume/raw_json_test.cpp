#include <gtest/gtest.h>

#include "volume/volume_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

/// Writes scan.json with these members beside scan.raw.
class RawJson : public ::testing::Test {
 protected:
  fs::path write(const std::string& members, const std::string& payload = counting_payload<std::uint8_t>(24)) {
    write_file(folder_ / "scan.raw", payload);
    return write_file(folder_ / "scan.json", "{" + members + "}");
  }
  std::string error(const std::string& members) { return read_error(write(members)); }

  const std::string base_ = R"("file": "scan.raw", "dims": [2, 3, 4], "type": "uint8")";
  TempFolder folder_;
};

TEST_F(RawJson, ReadsTheLeastThatIsNeeded) {
  const Volume volume = read_volume(write(base_));
  EXPECT_EQ(volume.samples(), counting_samples(24));
  EXPECT_EQ(volume.header().frame, Frame::kUnknown);
  EXPECT_TRUE(warns(volume, "1 mm"));
  ReadVolumeOptions options;
  options.spacing = Vector3{1, 2, 3};
  EXPECT_EQ(read_volume(folder_ / "scan.json", options).header().spacing(), (Vector3{1, 2, 3}));
}

TEST_F(RawJson, ReadsByteOrderOffsetScalingAndGzip) {
  const std::string members = R"("file": "scan.raw", "dims": [2, 3, 4], "type": "int16", "endian": "big",
      "offset": 5, "slope": 2, "intercept": 1, "spacing": [1, 1, 1])";
  const std::string payload = "12345" + counting_payload<std::int16_t>(24, true);
  EXPECT_EQ(read_volume(write(members, payload)).value(1, 2, 3), 47);
  EXPECT_EQ(read_volume(write(members, gzipped(payload))).value(1, 2, 3), 47);
}

TEST_F(RawJson, ReadsSpacingOriginDirectionUnitAndFrame) {
  const Volume volume = read_volume(write(base_ + R"(, "spacing": [0.1, 0.2, 0.3], "origin": [1, 2, 3], "unit": "cm",
      "direction": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "frame": "LPS")"));
  const Point3 p = volume.header().index_to_world({1, 2, 3});
  EXPECT_NEAR(p.x, 10 - 4, 1e-12);
  EXPECT_NEAR(p.y, 20 + 1, 1e-12);
  EXPECT_NEAR(p.z, 30 + 9, 1e-12);
  EXPECT_EQ(volume.header().frame, Frame::kLps);
}

TEST_F(RawJson, ReadsAnAffine) {
  const Volume volume = read_volume(write(base_ + R"(, "affine": [[1, 0.5, 0, 7], [0, 2, 0, 8], [0, 0, 3, 9]])"));
  EXPECT_EQ(volume.header().index_to_world({1, 1, 1}), (Point3{8.5, 10, 12}));
  ReadVolumeOptions options;
  options.spacing = Vector3{1, 2, 3};
  EXPECT_THROW(read_volume(folder_ / "scan.json", options), OptionError);
}

TEST_F(RawJson, NamesTheKeyThatIsWrong) {
  const std::pair<std::string, std::string> cases[] = {
      {base_ + R"(, "spacin": [1, 1, 1])", "unknown key 'spacin'"},
      {R"("file": "scan.raw", "dims": [2, 3, 4])", "'type' is missing"},
      {R"("file": "scan.raw", "type": "uint8")", "'dims' is missing"},
      {R"("dims": [2, 3, 4], "type": "uint8")", "'file' is missing"},
      {R"("file": "scan.raw", "dims": [2, 3], "type": "uint8")", "'dims' is not an array"},
      {R"("file": "scan.raw", "dims": [2, 3, 4.5], "type": "uint8")", "'dims' is no integer"},
      {R"("file": "scan.raw", "dims": [2, 3, 18446744073709551615], "type": "uint8")", "'dims' is no integer"},
      {R"("file": "scan.raw", "dims": [2, 3, 4], "type": "rgb24")", "type 'rgb24' is unknown"},
      {R"("file": "gone.raw", "dims": [2, 3, 4], "type": "uint8")", "gone.raw: no such file"},
      {base_ + R"(, "endian": "middle")", "endian 'middle'"},
      {base_ + R"(, "offset": -1)", "'offset' is negative"},
      {base_ + R"(, "spacing": [1, 0, 1])", "spacing along j is 0"},
      {base_ + R"(, "spacing": [1, null, 1])", "'spacing' is no number"},
      {base_ + R"(, "spacing": [1, 1, 1], "affine": [[1,0,0,0],[0,1,0,0],[0,0,1,0]])", "stands beside"},
      {base_ + R"(, "affine": [[1,0,0,0],[0,1,0,0],[0,0,0,0]])", "singular"},
      {base_ + R"(, "unit": "furlong")", "unit 'furlong'"},
      {base_ + R"(, "frame": "RAI")", "frame 'RAI'"},
      {base_ + ",", "not valid JSON"}};
  for (const auto& [members, expected] : cases) {
    EXPECT_NE(error(members).find(expected), std::string::npos) << error(members);
  }
}

}  // namespace
}  // namespace delvox
