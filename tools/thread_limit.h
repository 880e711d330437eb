#pragma once

#include <cstddef>
#include <memory>

namespace CLI {
class App;
}

namespace delvox::tools {

/// --threads N: how many threads the library may use, from the parsing of the flag to the end of this object. Without
/// the flag: as many as there are cores. No result depends on it.
class ThreadLimit {
 public:
  /// Adds the flag. pre: `app` parses while this lives, and it stays where it is.
  explicit ThreadLimit(CLI::App& app);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// The number of threads that may be used now.
std::size_t threads_in_use();

}  // namespace delvox::tools
