// Input that makes no sense: each case must give one clear line that names the file, the cause and the mend.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>

#include "volume/tiff_files.h"

namespace delvox {
namespace {

using namespace delvox::testing;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class HostileVolume : public ::testing::Test {
 protected:
  /// One line, naming the file, with a mend behind a semicolon, and with `part` in it.
  void expect_error(const fs::path& path, const std::string& part) {
    const std::string error = read_error(path);
    EXPECT_NE(error.find(part), std::string::npos) << "error: '" << error << "', expected: " << part;
    EXPECT_NE(error.find(path.stem().string()), std::string::npos) << error;
    EXPECT_NE(error.find("; "), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  void expect_error(const std::string& bytes, const std::string& part) {
    expect_error(write_file(folder_ / "scan.nii", bytes), part);
  }
  static NiftiFile plain() {
    NiftiFile file;
    file.payload = counting_payload<std::uint8_t>(24);
    return file;
  }

  TempFolder folder_;
};

TEST_F(HostileVolume, MissingEmptyAndFoldersAndPipes) {
  expect_error(folder_ / "gone.nii", "no such file");
  expect_error(folder_ / "no" / "folder" / "gone.nii", "no such file");
  expect_error(write_file(folder_ / "empty.nii", ""), "empty");
  fs::create_directory(folder_ / "folder");
  expect_error(folder_ / "folder", "no .tif or .tiff");
  write_file(folder_ / "folder" / "notes.txt", "hello");
  expect_error(folder_ / "folder", "no .tif or .tiff");
  fs::create_directory(folder_ / "folder.nii");
  expect_error(folder_ / "folder.nii", "no .tif or .tiff");
  ::mkfifo((folder_ / "pipe.nii").c_str(), 0600);
  expect_error(folder_ / "pipe.nii", "not a regular file");
}

TEST_F(HostileVolume, UnreadableFiles) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const fs::path path = write_file(folder_ / "locked.nii", plain().bytes());
  fs::permissions(path, fs::perms::none);
  expect_error(path, "permission denied");
}

TEST_F(HostileVolume, TruncatedHeadersDataAndGzip) {
  for (int version : {1, 2}) {
    NiftiFile file = plain();
    file.version = version;
    const std::string bytes = file.bytes();
    const std::string zipped = gzipped(bytes);
    for (std::size_t size = 1; size < bytes.size(); ++size) {
      EXPECT_NE(read_error(write_file(folder_ / "cut.nii", bytes.substr(0, size))), "") << size;
    }
    for (std::size_t size = 1; size < zipped.size(); ++size) {
      EXPECT_NE(read_error(write_file(folder_ / "cut.nii.gz", zipped.substr(0, size))), "") << size;
    }
    expect_error(bytes.substr(0, 200), "trunc");
    expect_error(bytes.substr(0, bytes.size() - 1), "truncated");
    expect_error(gzipped(bytes.substr(0, bytes.size() - 1)), "truncated");
    expect_error(zipped.substr(0, zipped.size() - 12), "truncated");
  }
}

TEST_F(HostileVolume, DamagedGzip) {
  const std::string zipped = gzipped(plain().bytes());
  for (std::size_t at = 10; at < zipped.size(); ++at) {
    std::string damaged = zipped;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    const std::string error = read_error(write_file(folder_ / "bad.nii.gz", damaged));
    EXPECT_NE(error, "") << "byte " << at;
  }
}

TEST_F(HostileVolume, WrongMagic) {
  std::string bytes = plain().bytes();
  bytes[344] = 'x';
  expect_error(bytes, "wrong magic");
  expect_error(std::string(1000, 'x'), "wrong magic");
  expect_error(write_file(folder_ / "a.inr", std::string(1000, 'x')), "wrong magic");
  expect_error(write_file(folder_ / "a.tif", std::string(1000, 'x')), "wrong magic");
  expect_error(write_file(folder_ / "a.vdb", std::string(1000, 'x')), "wrong magic");
  expect_error(write_file(folder_ / "a.json", std::string(1000, 'x')), "wrong magic");
  expect_error(write_file(folder_ / "a.xyz", std::string(1000, 'x')), "not a volume format");
  expect_error(write_file(folder_ / "a.dcm", std::string(128, '\0') + "DICM" + std::string(100, '\0')), "DICOM");
  expect_error(write_file(folder_ / "alone.img", std::string(1000, '\1')), "no .hdr beside it");
  NiftiFile pair = plain();
  pair.pair = true;
  expect_error(write_file(folder_ / "lonely.hdr", pair.header()), "no lonely.img beside it");
}

TEST_F(HostileVolume, DimensionsOfZeroNegativeAndHuge) {
  for (int version : {1, 2}) {
    NiftiFile file = plain();
    file.version = version;
    for (std::int64_t count : {0, -1, 8, 1000}) {
      file.dim[0] = count;
      expect_error(file.bytes(), "dim[0]");
    }
    for (int axis : {1, 2, 3, 4}) {
      for (std::int64_t size : {0, -5}) {
        file = plain();
        file.version = version;
        file.dim[0] = 4;
        file.dim[axis] = size;
        expect_error(file.bytes(), "dim[" + std::to_string(axis) + "]");
      }
    }
    file = plain();
    file.version = version;
    file.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1};
    expect_error(file.bytes(), "32767 x 32767 x 32767");
    file.dim = {3, 1000, 1000, 100, 1, 1, 1, 1};
    expect_error(file.bytes(), "truncated");
    expect_error(gzipped(file.bytes()), "truncated");
    file.dim = {7, 2, 3, 4, 32767, 32767, 32767, 32767};
    expect_error(file.bytes().substr(0, 352 + (version - 1) * 192), "overflow");
  }
  NiftiFile file = plain();
  file.version = 2;
  for (std::int64_t size : {std::int64_t{1000000000}, std::numeric_limits<std::int64_t>::max()}) {
    file.dim = {3, size, size, size, 1, 1, 1, 1};
    expect_error(file.bytes(), "x");
    file.dim = {7, 2, 3, 4, size, size, size, size};
    expect_error(file.bytes(), "overflow");
  }
}

/// Whichever volume is asked for: a header that promises more than there is, is in doubt as a whole.
TEST_F(HostileVolume, FilesThatLackSomeOfTheVolumesTheyPromise) {
  NiftiFile file = plain();
  file.version = 2;
  for (const std::int64_t volumes : {std::int64_t{1} << 62, std::int64_t{1} << 60, std::int64_t{1} << 40}) {
    file.dim = {5, 2, 3, 4, 1, volumes, 1, 1};
    const std::string bytes = file.bytes();
    const std::string part = volumes >> 60 != 0 ? "overflow" : "truncated";
    expect_error(bytes, part);
    expect_error(gzipped(bytes), part);
  }
  file.payload = counting_payload<std::uint8_t>(3 * 24);
  for (int version : {1, 2}) {
    file.version = version;
    file.dim = {4, 2, 3, 4, 3, 1, 1, 1};
    EXPECT_EQ(read_error(write_file(folder_ / "scan.nii", file.bytes())), "");
    expect_error(file.bytes().substr(0, file.bytes().size() - 1), "truncated");
    file.pair = true;
    const fs::path header = write_file(folder_ / "pair.hdr", file.header());
    write_file(folder_ / "pair.img", file.payload.substr(1));
    expect_error(header, "truncated");
    file.pair = false;
  }
}

TEST_F(HostileVolume, SpacingAndAffineWithoutSense) {
  NiftiFile file = plain();
  file.pixdim[2] = kNan;
  expect_error(file.bytes(), "pixdim[2] is not finite");
  file = plain();
  file.sform_code = 0;
  file.pixdim[1] = 0;
  expect_error(file.bytes(), "pixdim[1] is 0");
  file = plain();
  file.srow[5] = 0;
  expect_error(file.bytes(), "singular");
  file.srow[5] = kNan;
  expect_error(file.bytes(), "not finite");
  file = plain();
  file.sform_code = 0;
  file.qform_code = 1;
  file.quatern[0] = kNan;
  expect_error(file.bytes(), "not finite");
}

TEST_F(HostileVolume, SamplesThatAreNoScalars) {
  NiftiFile file = plain();
  const std::pair<int, std::string> types[] = {{32, "complex"}, {1792, "complex"}, {2048, "complex"}, {128, "RGB"},
                                               {2304, "RGB"},   {1536, "128-bit"}, {1, "single bits"}, {77, "unknown"}};
  for (const auto& [code, text] : types) {
    file.datatype = code;
    expect_error(file.bytes(), text);
  }
}

TEST_F(HostileVolume, SamplesThatAreNotFinite) {
  NiftiFile file;
  file.datatype = 64;
  file.bitpix = 64;
  file.dim = {3, 4, 1, 1, 1, 1, 1, 1};
  file.payload = bytes_of_all<double>({1, kNan, 1e300, std::numeric_limits<double>::infinity()});
  expect_error(file.bytes(), "3 samples are NaN, infinite or beyond float32");
}

TEST_F(HostileVolume, OffsetsWithoutSense) {
  NiftiFile file = plain();
  for (double offset : {kNan, 1.0, 351.0, 352.5, 1e30, -1e30}) {
    std::string bytes = file.bytes();
    bytes.replace(108, 4, bytes_of(static_cast<float>(offset)));
    expect_error(bytes, "vox_offset");
  }
  file.vox_offset = 1e6;
  expect_error(file.bytes(), "truncated");
  expect_error(gzipped(file.bytes()), "truncated");
}

TEST_F(HostileVolume, InrimageOfHugeNegativeAndNanFields) {
  const std::string fields[] = {"XDIM=1000000000\nYDIM=1000000000\nZDIM=1000000000\n", "XDIM=0\nYDIM=2\nZDIM=2\n",
                                "XDIM=-2\nYDIM=2\nZDIM=2\n", "XDIM=99999999999999999999\nYDIM=2\nZDIM=2\n",
                                "XDIM=2\nYDIM=2\nZDIM=2\nVX=nan\n", "XDIM=2\nYDIM=2\nZDIM=2\nVX=-1\n",
                                "XDIM=2\nYDIM=2\nZDIM=2\nVX=0\n", "XDIM=2\nYDIM=2\nZDIM=2\nTX=inf\n"};
  for (const std::string& field : fields) {
    const std::string bytes = "#INRIMAGE-4#{\n" + field + "TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=pc\n##}\n12345678";
    expect_error(write_file(folder_ / "scan.inr", bytes), "");
    EXPECT_NE(read_error(folder_ / "scan.inr"), "") << field;
  }
  expect_error(write_file(folder_ / "long.inr", "#INRIMAGE-4#{\n" + std::string(1 << 20, '\n')), "does not end");
}

TEST_F(HostileVolume, TiffPagesLargerThanTheFileCanHold) {
  TiffSpec spec;
  spec.pages = 1;
  const std::string bytes = read_file(write_tiff_file(folder_ / "s.tif", spec));
  const auto with_field = [&](std::uint16_t tag, std::uint32_t value) {
    std::string changed = bytes;
    // Entries are tag, type (3: 16 bits, 4: 32 bits), count, value; make it 32 bits wide.
    for (std::uint16_t type : {3, 4}) {
      const std::size_t at = changed.rfind(bytes_of(tag) + bytes_of(type) + bytes_of<std::uint32_t>(1));
      if (at == std::string::npos) continue;
      changed.replace(at + 2, 2, bytes_of<std::uint16_t>(4));
      changed.replace(at + 8, 4, bytes_of(value));
    }
    return changed;
  };
  for (std::uint32_t size : {0u, 1000000000u, 4294967295u}) {
    EXPECT_NE(read_error(write_file(folder_ / "w.tif", with_field(TIFFTAG_IMAGEWIDTH, size))), "");
    EXPECT_NE(read_error(write_file(folder_ / "h.tif", with_field(TIFFTAG_IMAGELENGTH, size))), "");
  }
}

TEST_F(HostileVolume, FoldersOfMixedThings) {
  TiffSpec spec;
  spec.pages = 1;
  write_tiff_file(folder_ / "a1.tif", spec);
  write_file(folder_ / "a2.tif", "this is no TIFF");
  const std::string error = read_error(folder_.path());
  EXPECT_NE(error.find("a2.tif"), std::string::npos) << error;
  write_file(folder_ / "a2.tif", "");
  EXPECT_NE(read_error(folder_.path()).find("a2.tif: the file is empty"), std::string::npos);
}

TEST_F(HostileVolume, NamesWithControlCharactersStayOnOneLine) {
  const std::string error = read_error(folder_ / "two\nlines.nii");
  EXPECT_NE(error.find("two?lines.nii: no such file"), std::string::npos) << error;
}

}  // namespace
}  // namespace delvox
