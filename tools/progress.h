#pragma once

#include <chrono>
#include <set>
#include <string>

#include "delvox/core/run.h"

namespace delvox::tools {

/// When to say something: once for each stage, and else not before `interval` has passed since. Refinement and repair
/// take turns by the hundred: a stage that comes back is no news.
class ProgressPace {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProgressPace(Clock::duration interval) : interval_(interval) {}
  bool due(const std::string& stage, Clock::time_point now);

 private:
  Clock::duration interval_;
  std::set<std::string> told_;
  Clock::time_point last_;
};

/// Shows the progress of meshers on stderr: a bar on a terminal, otherwise a line for each stage and every ten seconds.
class ProgressDisplay {
 public:
  enum class Style { kNone, kLines, kBar };

  /// kNone if quiet, else what suits stderr.
  static Style style_for_stderr(bool quiet);

  explicit ProgressDisplay(Style style);
  ~ProgressDisplay() { clear(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);
  /// Takes the bar away, for other lines to follow.
  void clear();

 private:
  Style style_;
  ProgressPace pace_;
  bool bar_visible_ = false;
};

}  // namespace delvox::tools
