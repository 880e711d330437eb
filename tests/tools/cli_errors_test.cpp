// Exit codes and error lines of the real program: every failing run says one line and leaves nothing half-written.
#include <gtest/gtest.h>
#include <unistd.h>

#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

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

TEST_F(CliErrors, NothingToMeshExitsWith4) {
  expect_tet_failure(4, {"--iso", "1e6"});
  expect_tet_failure(4, {"--crop", "100:200,0:5,0:5"});
  expect_tet_failure(4, {"--min-component", "1e9"}, {"--min-component"});
}

TEST_F(CliErrors, AnOutputThatCannotBeWrittenExitsWith6BeforeAnyWork) {
  expect_failure(6, {"tet", in_folder("not_read_yet.nii"), "-o", in_folder("no_such_folder/out.vtu")}, {"no_such_folder"});
  expect_failure(6, {"tet", volume(), "-o", in_folder("out.vtu"), "--report", "/dev/null"}, {"/dev/null"});
  expect_failure(6, {"surface", volume(), "-o", in_folder("out.vtu"), "-o", "/no/such/out.stl"}, {"/no/such"});
  expect_failure(6, {"phantom", "sphere", "-o", in_folder("no_such_folder/v.nii")}, {"no_such_folder"});
  if (::geteuid() != 0) expect_failure(6, {"convert", volume(), "-o", "/out.stl"}, {"/out.stl"});
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
