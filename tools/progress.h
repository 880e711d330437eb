#pragma once

#include <chrono>
#include <string>

#include "delvox/core/run.h"

namespace delvox::tools {

/// Shows the progress of a mesher on stderr: a bar on a terminal, otherwise a line for each stage and every ten seconds.
class ProgressDisplay {
 public:
  enum class Style { kNone, kLines, kBar };

  /// kNone if quiet, else what suits stderr.
  static Style style_for_stderr(bool quiet);

  explicit ProgressDisplay(Style style) : style_(style) {}
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  Style style_;
  std::string stage_;
  Clock::time_point shown_;
  bool bar_visible_ = false;
};

}  // namespace delvox::tools
