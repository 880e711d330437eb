#include "tools/run_delvox.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace delvox::test {
namespace {

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe2");
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    ::close(read_end);
    close_write_end();
  }
  void close_write_end() {
    if (write_end >= 0) ::close(write_end);
    write_end = -1;
  }
};

[[noreturn]] void become_delvox(std::vector<std::string> arguments, const RunSetup& setup, int out, int err) {
  if (setup.file_size_limit > 0) {
    const rlimit limit{setup.file_size_limit, setup.file_size_limit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (!setup.stdout_path.empty()) out = ::open(setup.stdout_path.c_str(), O_WRONLY);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  if (::chdir(setup.folder.c_str()) != 0) ::_exit(126);
  arguments.insert(arguments.begin(), "delvox");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(DELVOX_PROGRAM, argv.data());
  ::_exit(127);
}

// Reads both pipes to their ends; sends the signals once stderr holds what it waits for.
void collect(pid_t child, const RunSetup& setup, int out, int err, Outcome& outcome) {
  pollfd ends[2] = {{out, POLLIN, 0}, {err, POLLIN, 0}};
  bool signalled = setup.signals.empty();
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    ::poll(ends, 2, -1);
    for (int i = 0; i < 2; ++i) {
      if (ends[i].fd < 0 || ends[i].revents == 0) continue;
      char buffer[4096];
      const ssize_t count = ::read(ends[i].fd, buffer, sizeof buffer);
      if (count <= 0) {
        ends[i].fd = -1;
      } else {
        (i == 0 ? outcome.out : outcome.err).append(buffer, static_cast<std::size_t>(count));
      }
    }
    if (!signalled && outcome.err.find(setup.signal_after) != std::string::npos) {
      for (int signal : setup.signals) ::kill(child, signal);
      signalled = true;
    }
  }
}

}  // namespace

Outcome run_delvox(const std::vector<std::string>& arguments, const RunSetup& setup) {
  Pipe out, err;
  const pid_t child = ::fork();
  if (child == 0) become_delvox(arguments, setup, out.write_end, err.write_end);
  out.close_write_end();
  err.close_write_end();
  Outcome outcome;
  collect(child, setup, out.read_end, err.read_end, outcome);
  int status = 0;
  ::waitpid(child, &status, 0);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "delvox_test_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

void write_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::size_t line_count(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace delvox::test
