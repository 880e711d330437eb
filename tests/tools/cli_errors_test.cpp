// Exit codes and error lines of the real program: every failing run says one line and leaves nothing half-written.
#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>

#include "tools/run_delvox.h"
#include "volume/tiff_files.h"

namespace delvox::test {
namespace {

namespace fs = std::filesystem;
namespace testing = delvox::testing;

class CliErrors : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const Outcome made = run_delvox({"phantom", "sphere", "--dims", "24,24,24", "-o", volume(), "--quiet"});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::string volume() { return *folder_ / "sphere.nii"; }
  static std::string in_folder(const std::string& name) { return *folder_ / name; }

  // Runs with --quiet; expects the code, exactly one line on stderr that mentions all of `words`, nothing on stdout, and
  // no new file.
  static void expect_failure(int code, std::vector<std::string> arguments, const std::vector<std::string>& words = {}) {
    const std::vector<std::string> before = folder_->names();
    arguments.push_back("--quiet");
    const Outcome outcome = run_delvox(arguments, {.folder = folder_->path()});
    std::string command;
    for (const std::string& argument : arguments) command += argument + " ";
    SCOPED_TRACE(command + "\n" + outcome.err);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(line_count(outcome.err), 1u);
    EXPECT_EQ(outcome.out, "");
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << word;
    EXPECT_EQ(folder_->names(), before);
  }

  static void expect_tet_failure(int code, std::vector<std::string> more, const std::vector<std::string>& words = {}) {
    more.insert(more.begin(), {"tet", volume(), "-o", in_folder("out.vtu")});
    expect_failure(code, std::move(more), words);
  }

 private:
  static TemporaryFolder* folder_;
};
TemporaryFolder* CliErrors::folder_ = nullptr;

TEST_F(CliErrors, AnUnknownVerbOrFlagIsAUsageError) {
  expect_failure(2, {"mesh"}, {"mesh", "--help"});
  expect_tet_failure(2, {"--sise", "3"}, {"--sise"});
  expect_failure(2, {"tet", volume()}, {"--output"});
  EXPECT_EQ(run_delvox({}).code, 2);
}

TEST_F(CliErrors, AValueOutsideItsRangeIsAUsageError) {
  expect_tet_failure(2, {"--min-angle", "31"}, {"--min-angle"});
  expect_tet_failure(2, {"--min-angle", "nan"}, {"min-angle"});
  expect_tet_failure(2, {"--radius-edge", "1.9"}, {"--radius-edge"});
  expect_tet_failure(2, {"--size", "0"}, {"--size"});
  expect_tet_failure(2, {"--size", "-3"}, {"--size"});
  expect_tet_failure(2, {"--size", "1e999"}, {"--size"});
  expect_tet_failure(2, {"--size", "three"}, {"--size", "three"});
  expect_tet_failure(2, {"--max-deviation", "inf"}, {"--max-deviation"});
  expect_tet_failure(2, {"--size", "3", "--tets", "1000"}, {"--tets"});
  expect_tet_failure(2, {"--frame", "xyz"}, {"--frame"});
  expect_tet_failure(2, {"--spacing", "1,2"}, {"--spacing"});
  expect_tet_failure(2, {"--iso", "otsu9:1"}, {"otsu9:1"});
  expect_tet_failure(2, {"--crop", "1:2,3"}, {"1:2,3"});
}

TEST_F(CliErrors, OutputsThatMakeNoSenseAreUsageErrors) {
  expect_failure(2, {"tet", volume(), "-o", in_folder("out.xyz")}, {"out.xyz"});
  expect_failure(2, {"tet", volume(), "-o", in_folder("a.vtu"), "-o", in_folder("./a.vtu")}, {"twice"});
  expect_failure(2, {"tet", volume(), "-o", in_folder("a.vtu"), "--report", volume()}, {"input"});
}

TEST_F(CliErrors, AConfigFileWithAnUnknownKeyOrNoJsonIsAUsageError) {
  write_file(in_folder("unknown.json"), R"({"sise": 3})");
  write_file(in_folder("broken.json"), "{\"size\": ");
  write_file(in_folder("list.json"), "[1, 2]");
  write_file(in_folder("object.json"), R"({"size": {"value": 3}})");
  expect_tet_failure(2, {"--config", in_folder("unknown.json")}, {"sise"});
  expect_tet_failure(2, {"--config", in_folder("broken.json")}, {"JSON"});
  expect_tet_failure(2, {"--config", in_folder("list.json")}, {"object"});
  expect_tet_failure(2, {"--config", in_folder("object.json")}, {"size"});
  expect_tet_failure(2, {"--config", in_folder("missing.json")}, {"missing.json"});
}

TEST_F(CliErrors, InputThatCannotBeReadExitsWith3) {
  write_file(in_folder("empty.nii"), "");
  write_file(in_folder("text.nii"), "this is no volume at all, whatever its name says");
  write_file(in_folder("cut.nii"), read_file(volume()).substr(0, 5000));
  write_file(in_folder("empty.stl"), "");
  for (const char* name : {"missing.nii", "empty.nii", "text.nii", "cut.nii"}) {
    expect_failure(3, {"info", in_folder(name)}, {name});
    expect_failure(3, {"tet", in_folder(name), "-o", in_folder("out.vtu")}, {name});
  }
  expect_failure(3, {"check", in_folder("empty.stl")}, {"empty.stl"});
  expect_failure(3, {"check", in_folder("missing.vtu")}, {"missing.vtu"});
  expect_failure(3, {"convert", in_folder("missing.vtu"), "-o", in_folder("out.stl")}, {"missing.vtu"});
}

TEST_F(CliErrors, VolumesWithoutSenseExitWith3) {
  testing::NiftiFile good;
  good.payload = testing::counting_payload<std::uint8_t>(24);
  const auto expect_refused = [&](const char* name, const std::string& bytes, const char* word) {
    write_file(in_folder(name), bytes);
    expect_failure(3, {"tet", in_folder(name), "-o", in_folder("out.vtu")}, {name, word});
  };
  const auto expect_header_refused = [&](const char* name, auto change, const char* word) {
    testing::NiftiFile file = good;
    change(file);
    expect_refused(name, file.bytes(), word);
  };
  const std::string zipped = testing::gzipped(good.bytes());
  expect_refused("header.nii", good.bytes().substr(0, 200), "trunc");
  expect_refused("cut.nii.gz", zipped.substr(0, zipped.size() - 12), "truncated");
  expect_header_refused("zero.nii", [](auto& f) { f.dim[2] = 0; }, "dim[2]");
  expect_header_refused("negative.nii", [](auto& f) { f.dim[1] = -5; }, "dim[1]");
  expect_header_refused("huge.nii", [](auto& f) { f.version = 2, f.dim[1] = 1'000'000'000; }, "1000000000");
  expect_header_refused(
      "overflow.nii", [](auto& f) { f.version = 2, f.dim = {5, 2, 3, 4, 1LL << 62, 1LL << 62, 1, 1}; }, "overflow");
  expect_header_refused("spacing.nii", [](auto& f) { f.pixdim[2] = std::numeric_limits<double>::quiet_NaN(); },
                        "pixdim[2]");
  expect_header_refused("affine.nii", [](auto& f) { f.srow[5] = 0; }, "singular");
  expect_header_refused("colour.nii", [](auto& f) { f.datatype = 128; }, "RGB");
  expect_header_refused("complex.nii", [](auto& f) { f.datatype = 32; }, "complex");
}

TEST_F(CliErrors, FoldersThatHoldNoStackExitWith3) {
  fs::create_directory(in_folder("none"));
  expect_failure(3, {"info", in_folder("none")}, {"none", "no .tif or .tiff"});
  for (const bool sizes : {true, false}) {
    const fs::path folder = in_folder(sizes ? "sizes" : "types");
    fs::create_directory(folder);
    testing::TiffSpec slice;
    slice.pages = 1;
    testing::write_tiff_file(folder / "s1.tif", slice);
    if (sizes) slice.width += 1;
    if (!sizes) slice.bits = 16;
    testing::write_tiff_file(folder / "s2.tif", slice);
    expect_failure(3, {"info", folder.string(), "--spacing", "1,1,1"}, {"s1.tif", "s2.tif"});
  }
}

TEST_F(CliErrors, NothingToMeshExitsWith4) {
  expect_tet_failure(4, {"--iso", "1e6"}, {volume() + ": isovalue"});
  expect_tet_failure(4, {"--crop", "100:200,0:5,0:5"});
  expect_tet_failure(4, {"--min-component", "1e9"}, {"--min-component"});
}

TEST_F(CliErrors, AnOutputThatCannotBeWrittenExitsWith6BeforeAnyWork) {
  expect_failure(6, {"tet", in_folder("not_read_yet.nii"), "-o", in_folder("no_such_folder/out.vtu")}, {"no_such_folder"});
  expect_failure(6, {"tet", volume(), "-o", in_folder("out.vtu"), "--report", "/dev/null"}, {"/dev/null"});
  expect_failure(6, {"surface", volume(), "-o", in_folder("out.vtu"), "-o", "/no/such/out.stl"}, {"/no/such"});
  expect_failure(6, {"phantom", "sphere", "-o", in_folder("no_such_folder/v.nii")}, {"no_such_folder"});
  // Not even root may write here; OutputFileTest has a read-only folder of its own.
  if (fs::exists("/proc/self")) expect_failure(6, {"tet", volume(), "-o", "/proc/out.vtu"}, {"/proc"});
}

TEST_F(CliErrors, AFileSizeLimitLeavesNothingHalfWritten) {
  TemporaryFolder out;
  const Outcome outcome = run_delvox({"tet", volume(), "--size", "2", "-o", out / "big.inp", "--quiet"},
                                     {.file_size_limit = 20000});
  EXPECT_EQ(outcome.code, 6);
  EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("big.inp"), std::string::npos) << outcome.err;
  EXPECT_TRUE(out.names().empty());
}

TEST_F(CliErrors, AFullStandardOutputExitsWith6) {
  if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(run_delvox({"info", volume()}, {.stdout_path = "/dev/full"}).code, 6);
}

}  // namespace
}  // namespace delvox::test
