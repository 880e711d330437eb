#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "delvox/core/run.h"

namespace delvox::tools {

/// Times the stages of a run.
class Stopwatch {
 public:
  /// Runs `work`, notes its time under `stage`, and returns what it returns.
  template <class Work>
  auto timed(const std::string& stage, Work&& work) {
    struct Note {
      Stopwatch& watch;
      const std::string& stage;
      Clock::time_point begin = Clock::now();
      ~Note() { watch.stages_.push_back({stage, std::chrono::duration<double>(Clock::now() - begin).count()}); }
    } note{*this, stage};
    return std::forward<Work>(work)();
  }

  const std::vector<StageTime>& stages() const { return stages_; }
  double total() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
  std::vector<StageTime> stages_;
};

}  // namespace delvox::tools
