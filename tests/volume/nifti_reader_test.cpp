#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "volume/volume_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Volume read_bytes(const std::string& bytes, const std::string& name = "scan.nii",
                  const ReadVolumeOptions& options = {}) {
  const TempFolder folder;
  return read_volume(write_file(folder / name, bytes), options);
}

void expect_point(const Point3& actual, const Point3& expected, double tolerance = 1e-5) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

struct Datatype {
  int code, bits;
  std::string name;
  std::string (*payload)(std::size_t, bool);
};

class EveryDatatype : public ::testing::TestWithParam<std::tuple<int, bool, Datatype>> {};

TEST_P(EveryDatatype, IsReadInBothVersionsAndByteOrders) {
  const auto& [version, big_endian, datatype] = GetParam();
  NiftiFile file;
  file.version = version;
  file.big_endian = big_endian;
  file.datatype = datatype.code;
  file.bitpix = datatype.bits;
  file.payload = datatype.payload(24, big_endian);
  const Volume volume = read_bytes(file.bytes());
  EXPECT_EQ(volume.samples(), counting_samples(24));
  EXPECT_EQ(volume.dims(), (std::array<int, 3>{2, 3, 4}));
  EXPECT_EQ(volume.header().sample_type, datatype.name);
  EXPECT_EQ(volume.header().format, version == 1 ? "NIfTI-1" : "NIfTI-2");
  EXPECT_EQ(volume.header().frame, Frame::kRas);
  EXPECT_TRUE(volume.header().warnings.empty()) << volume.header().warnings.front();
}

INSTANTIATE_TEST_SUITE_P(
    Nifti, EveryDatatype,
    ::testing::Combine(::testing::Values(1, 2), ::testing::Bool(),
                       ::testing::Values(Datatype{256, 8, "int8", counting_payload<std::int8_t>},
                                         Datatype{2, 8, "uint8", counting_payload<std::uint8_t>},
                                         Datatype{4, 16, "int16", counting_payload<std::int16_t>},
                                         Datatype{512, 16, "uint16", counting_payload<std::uint16_t>},
                                         Datatype{8, 32, "int32", counting_payload<std::int32_t>},
                                         Datatype{768, 32, "uint32", counting_payload<std::uint32_t>},
                                         Datatype{1024, 64, "int64", counting_payload<std::int64_t>},
                                         Datatype{1280, 64, "uint64", counting_payload<std::uint64_t>},
                                         Datatype{16, 32, "float32", counting_payload<float>},
                                         Datatype{64, 64, "float64", counting_payload<double>})),
    [](const auto& info) {
      return std::get<2>(info.param).name + "_v" + std::to_string(std::get<0>(info.param)) +
             (std::get<1>(info.param) ? "_big" : "_little");
    });

NiftiFile plain_file() {
  NiftiFile file;
  file.payload = counting_payload<std::uint8_t>(24);
  return file;
}

TEST(NiftiReader, RecognisesTheContentWhateverTheName) {
  EXPECT_EQ(read_bytes(plain_file().bytes(), "scan.dat").header().format, "NIfTI-1");
  EXPECT_EQ(read_bytes(gzipped(plain_file().bytes()), "scan.nii").header().format, "NIfTI-1");
}

TEST(NiftiReader, ReadsGzipInSeveralMembersAndIgnoresTrailingZeros) {
  const std::string bytes = plain_file().bytes();
  const std::string members = gzipped(bytes.substr(0, 100)) + gzipped(bytes.substr(100)) + std::string(512, '\0');
  EXPECT_EQ(read_bytes(members, "scan.nii.gz").samples(), counting_samples(24));
}

TEST(NiftiReader, ReadsPairsByEitherNamePlainOrGzipped) {
  for (int version : {1, 2}) {
    NiftiFile file = plain_file();
    file.pair = true;
    file.version = version;
    for (bool zip_header : {false, true}) {
      for (bool zip_image : {false, true}) {
        const TempFolder folder;
        const fs::path header = folder / (zip_header ? "scan.hdr.gz" : "scan.hdr");
        const fs::path image = folder / (zip_image ? "scan.img.gz" : "scan.img");
        write_file(header, zip_header ? gzipped(file.header()) : file.header());
        write_file(image, zip_image ? gzipped(file.payload) : file.payload);
        EXPECT_EQ(read_volume(header).samples(), counting_samples(24));
        EXPECT_EQ(read_volume(image).samples(), counting_samples(24));
      }
    }
  }
}

TEST(NiftiReader, KeepsTheFullSformEvenIfSheared) {
  NiftiFile file = plain_file();
  file.srow = {2, 0.5, 0, -10, 0, 3, 0.25, 20, 0.125, 0, -4, 30};
  const Volume volume = read_bytes(file.bytes());
  expect_point(volume.header().index_to_world({0, 0, 0}), {-10, 20, 30});
  expect_point(volume.header().index_to_world({1, 2, 3}), {-7, 26.75, 18.125});
  EXPECT_EQ(volume.header().orientation(), "RAI");
}

TEST(NiftiReader, PrefersSformAndWarnsIfQformDisagrees) {
  NiftiFile file = plain_file();
  file.srow[3] = 7;
  file.qform_code = 1;
  const Volume volume = read_bytes(file.bytes());
  expect_point(volume.header().index_to_world({0, 0, 0}), {7, 0, 0});
  EXPECT_TRUE(warns(volume, "sform and qform disagree"));
}

// Quaternion of a turn by `angle` about the unit axis, and what it does to a point, by Rodrigues' formula.
Point3 rotated(const Point3& p, const Vector3& axis, double angle) {
  return std::cos(angle) * p + std::sin(angle) * cross(axis, p) + (1 - std::cos(angle)) * dot(axis, p) * axis;
}

TEST(NiftiReader, TurnsByTheQuaternionOfQform) {
  const Vector3 axis = (1 / std::sqrt(14.0)) * Vector3{1, 2, 3};
  for (double angle : {0.3, 1.7, 3.0, 3.14159265358979}) {
    for (double qfac : {1.0, -1.0, 0.0}) {
      NiftiFile file = plain_file();
      file.version = 2;
      file.sform_code = 0;
      file.qform_code = 1;
      file.pixdim = {qfac, 0.5, 1.5, 2.5, 1, 1, 1, 1};
      const double s = std::sin(angle / 2);
      file.quatern = {s * axis.x, s * axis.y, s * axis.z, 4, 5, 6};
      const Volume volume = read_bytes(file.bytes());
      const Point3 scaled{0.5 * 1, 1.5 * 2, 2.5 * 3 * (qfac < 0 ? -1 : 1)};
      expect_point(volume.header().index_to_world({1, 2, 3}), rotated(scaled, axis, angle) + Point3{4, 5, 6}, 1e-6);
    }
  }
}

TEST(NiftiReader, TakesSformAndQformOfTheSameRotationAsEqual) {
  NiftiFile file = plain_file();
  file.qform_code = file.sform_code = 1;
  file.pixdim = {1, 1, 2, 3, 1, 1, 1, 1};
  file.quatern = {0, 0, std::sqrt(0.5), 1, 2, 3};  // a quarter turn about z
  file.srow = {0, -2, 0, 1, 1, 0, 0, 2, 0, 0, 3, 3};
  EXPECT_TRUE(read_bytes(file.bytes()).header().warnings.empty());
}

TEST(NiftiReader, FallsBackToPixdimAndSaysSo) {
  NiftiFile file = plain_file();
  file.sform_code = 0;
  file.pixdim = {1, 0.5, -0.75, 2, 1, 1, 1, 1};
  const Volume volume = read_bytes(file.bytes());
  expect_point(volume.header().index_to_world({1, 1, 1}), {0.5, 0.75, 2});
  EXPECT_TRUE(warns(volume, "neither sform nor qform"));
  EXPECT_TRUE(warns(volume, "negative"));
}

TEST(NiftiReader, HonoursTheUnitOfLength) {
  const std::pair<int, double> units[] = {{1, 1000}, {2, 1}, {3, 0.001}, {0, 1}, {2 + 8, 1}, {5, 1}};
  for (const auto& [code, factor] : units) {
    NiftiFile file = plain_file();
    file.units = code;
    file.srow[3] = 2;
    const Volume volume = read_bytes(file.bytes());
    EXPECT_DOUBLE_EQ(volume.header().spacing().x, factor);
    EXPECT_DOUBLE_EQ(volume.header().index_to_world({0, 0, 0}).x, 2 * factor);
    EXPECT_EQ(warns(volume, "unit"), code == 0 || code == 5);
  }
}

TEST(NiftiReader, ScalesBySlopeAndInterceptUnlessTheyMeanNothing) {
  NiftiFile file = plain_file();
  file.slope = 2;
  file.intercept = -1;
  EXPECT_EQ(read_bytes(file.bytes()).value(1, 2, 3), 2 * 23 - 1);
  for (double nothing : {0.0, kNan, std::numeric_limits<double>::infinity()}) {
    file.slope = nothing;
    EXPECT_EQ(read_bytes(file.bytes()).value(1, 2, 3), 23);
  }
  file.slope = 2;
  file.intercept = kNan;
  EXPECT_EQ(read_bytes(file.bytes()).value(1, 2, 3), 46);
}

TEST(NiftiReader, SelectsAVolumeOfA4dFile) {
  NiftiFile file;
  file.dim = {5, 2, 2, 2, 3, 2, 1, 1};
  file.payload = counting_payload<std::uint8_t>(48);
  for (const bool zip : {false, true}) {
    const std::string bytes = zip ? gzipped(file.bytes()) : file.bytes();
    ReadVolumeOptions options;
    EXPECT_EQ(read_bytes(bytes, "scan", options).value(0, 0, 0), 0);
    EXPECT_TRUE(warns(read_bytes(bytes, "scan", options), "6 volumes"));
    options.volume_index = 5;
    EXPECT_EQ(read_bytes(bytes, "scan", options).value(1, 0, 0), 41);
    for (int outside : {-1, 6}) {
      options.volume_index = outside;
      EXPECT_THROW(read_bytes(bytes, "scan", options), InputError);
    }
  }
}

TEST(NiftiReader, ReadsImagesOfOneAndTwoDimensions) {
  NiftiFile file = plain_file();
  file.dim = {2, 4, 6, 99, 99, 1, 1, 1};
  EXPECT_EQ(read_bytes(file.bytes()).dims(), (std::array<int, 3>{4, 6, 1}));
  file.dim = {1, 24, 99, 99, 99, 1, 1, 1};
  EXPECT_EQ(read_bytes(file.bytes()).dims(), (std::array<int, 3>{24, 1, 1}));
}

TEST(NiftiReader, SkipsExtensionsBeforeTheSamples) {
  NiftiFile file = plain_file();
  file.vox_offset = 352 + 64;
  file.payload = std::string(64, 'x') + file.payload;
  EXPECT_EQ(read_bytes(file.bytes()).samples(), counting_samples(24));
  EXPECT_EQ(read_bytes(gzipped(file.bytes())).samples(), counting_samples(24));
}

TEST(NiftiReader, WarnsOnceOfSamplesThatFloat32CannotHold) {
  NiftiFile file;
  file.dim = {3, 2, 1, 1, 1, 1, 1, 1};
  file.datatype = 8;
  file.bitpix = 32;
  file.payload = bytes_of_all<std::int32_t>({16777217, 5});
  const Volume volume = read_bytes(file.bytes());
  EXPECT_EQ(volume.header().warnings.size(), 1u);
  EXPECT_TRUE(warns(volume, "1 samples of type int32 were rounded"));
  file.payload = bytes_of_all<std::int32_t>({std::numeric_limits<std::int32_t>::max(), -16777216});
  EXPECT_TRUE(warns(read_bytes(file.bytes()), "rounded"));
}

TEST(NiftiReader, RefusesAnOptionForSpacing) {
  ReadVolumeOptions options;
  options.spacing = Vector3{1, 1, 1};
  EXPECT_THROW(read_bytes(plain_file().bytes(), "scan.nii", options), OptionError);
}

}  // namespace
}  // namespace delvox
