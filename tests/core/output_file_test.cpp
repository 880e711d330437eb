#include "core/output_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class OutputFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "delvox_output_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    std::error_code ignored;
    fs::permissions(folder_, fs::perms::owner_all, ignored);
    fs::remove_all(folder_, ignored);
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_;
};

/// The message of the IoError that `action` throws; empty if it throws none.
template <class Action>
std::string io_error(const Action& action) {
  try {
    action();
  } catch (const IoError& error) {
    return error.what();
  }
  return {};
}

TEST_F(OutputFileTest, AppearsWithItsWholeContentOnCommitOnly) {
  const fs::path path = folder_ / "mesh.vtu";
  OutputFile file(path);
  file.stream() << "some bytes";
  EXPECT_FALSE(fs::exists(path));
  EXPECT_EQ(file.temporary().parent_path(), folder_);
  file.commit();
  EXPECT_EQ(content(path), "some bytes");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFileTest, LeavesNothingWithoutCommitAndTheOldFileUntouched) {
  const fs::path path = folder_ / "mesh.vtu";
  std::ofstream(path) << "old";
  {
    OutputFile file(path);
    file.stream() << "new, but never finished";
  }
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFileTest, ReplacesAFileThatIsThere) {
  const fs::path path = folder_ / "mesh.vtu";
  std::ofstream(path) << "old and longer";
  OutputFile file(path);
  file.stream() << "new";
  file.commit();
  EXPECT_EQ(content(path), "new");
}

TEST_F(OutputFileTest, TakesWhatALibraryWroteUnderTheTemporaryName) {
  const fs::path path = folder_ / "volume.vdb";
  OutputFile file(path);
  std::ofstream(file.temporary(), std::ios::binary) << "by a library";
  file.commit_external();
  EXPECT_EQ(content(path), "by a library");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFileTest, TwoFilesForTheSamePathDoNotGetInEachOthersWay) {
  const fs::path path = folder_ / "mesh.vtu";
  OutputFile first(path), second(path);
  EXPECT_NE(first.temporary(), second.temporary());
  first.stream() << "first";
  second.stream() << "second";
  first.commit();
  second.commit();
  EXPECT_EQ(content(path), "second");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(OutputFileTest, RefusesAMissingFolderAndDoesNotCreateIt) {
  const fs::path path = folder_ / "missing" / "mesh.vtu";
  EXPECT_NE(io_error([&] { check_output_path(path); }).find("missing does not exist"), std::string::npos);
  EXPECT_NE(io_error([&] { OutputFile file(path); }), "");
  EXPECT_EQ(entries(), 0u);
}

TEST_F(OutputFileTest, RefusesWhatIsNoRegularFile) {
  const fs::path folder = folder_ / "folder.vtu", pipe = folder_ / "pipe.vtu";
  fs::create_directory(folder);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(io_error([&] { check_output_path(folder); }).find("not a regular file"), std::string::npos);
  EXPECT_NE(io_error([&] { check_output_path(pipe); }).find("not a regular file"), std::string::npos);
  EXPECT_NE(io_error([&] { check_output_path("/dev/null"); }), "");
  EXPECT_NE(io_error([&] { check_output_path(folder_ / ""); }).find("no file name"), std::string::npos);
}

TEST_F(OutputFileTest, RefusesAFileAsFolder) {
  std::ofstream(folder_ / "file") << "x";
  EXPECT_NE(io_error([&] { check_output_path(folder_ / "file" / "mesh.vtu"); }), "");
}

/// Root may write everywhere: as long as one of these lives, the test runs as nobody instead.
class AsNobody {
 public:
  AsNobody() {
    if (::geteuid() == 0) changed_ = ::setresuid(kNobody, kNobody, 0) == 0;
  }
  ~AsNobody() {
    if (changed_ && ::setresuid(0, 0, 0) != 0) std::abort();
  }

 private:
  static constexpr uid_t kNobody = 65534;
  bool changed_ = false;
};

TEST_F(OutputFileTest, RefusesAReadOnlyFolder) {
  fs::permissions(folder_, fs::perms(0555));
  const AsNobody nobody;
  EXPECT_NE(io_error([&] { check_output_path(folder_ / "mesh.vtu"); }).find("Permission denied"), std::string::npos);
  EXPECT_NE(io_error([&] { OutputFile file(folder_ / "mesh.vtu"); }), "");
}

TEST_F(OutputFileTest, TellsOfADiskThatTakesNoMoreAndLeavesNothing) {
  const fs::path path = folder_ / "mesh.vtu";
  rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  {
    OutputFile file(path);
    file.stream() << std::string(100000, 'x');
    message = io_error([&] { file.commit(); });
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find(path.string()), std::string::npos);
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_EQ(entries(), 0u);
}

TEST_F(OutputFileTest, AnInterruptedRunCanRemoveWhatItHasBegun) {
  OutputFile first(folder_ / "a.vtu"), second(folder_ / "b.stl");
  OutputFile done(folder_ / "c.stl");
  done.commit();
  EXPECT_EQ(entries(), 3u);
  remove_unfinished_outputs();
  EXPECT_EQ(entries(), 1u);
  EXPECT_TRUE(fs::exists(folder_ / "c.stl"));
}

}  // namespace
}  // namespace delvox
