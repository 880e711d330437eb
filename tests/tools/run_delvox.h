#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace delvox::test {

/// How a run of the real program ended.
struct Outcome {
  int code = -1;  ///< exit code; 128 + signal if a signal ended it
  std::string out, err;
};

struct RunSetup {
  std::filesystem::path folder = ".";   ///< where it runs
  std::size_t file_size_limit = 0;      ///< bytes, as ulimit -f; 0: none
  std::string stdout_path = {};              ///< instead of being captured
  std::vector<int> signals = {};        ///< sent once its stderr contains `signal_after`
  std::string signal_after = {};
};

/// Runs the delvox program that was built with these tests.
Outcome run_delvox(const std::vector<std::string>& arguments, const RunSetup& setup = {});

/// A folder of its own for a test, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }
  /// Names of what it holds, hidden files too, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& content);

/// Number of line ends.
std::size_t line_count(const std::string& text);

}  // namespace delvox::test
