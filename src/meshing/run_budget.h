#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <string>

#include "delvox/core/run.h"

namespace delvox {

/// Watches over a run: limits, progress, cancelling, and the time of each stage.
class RunBudget {
 public:
  RunBudget(const RunControl& control, RunReport& report);

  /// Ends the stage under way, if any, and begins another. `stage` must outlive the run.
  void begin_stage(const char* stage);
  void end_stage();
  /// To be called once per insertion. False once a limit is reached (told in the report) and ever after.
  /// Throws Cancelled.
  bool go_on(std::size_t vertices, std::size_t waiting);
  /// The same where calls lie far apart: looks at the clock each time.
  bool go_on_now(std::size_t vertices, std::size_t waiting) {
    calls_ = 0;
    return go_on(vertices, waiting);
  }
  /// May the mesh get so many vertices?
  bool room_for(std::size_t vertices) const {
    return control_.limits.max_vertices == 0 || vertices <= control_.limits.max_vertices;
  }
  /// How many more vertices the mesh may get.
  std::size_t room(std::size_t vertices) const {
    const std::size_t most = control_.limits.max_vertices;
    return most == 0 ? std::numeric_limits<std::size_t>::max() : most - std::min(most, vertices);
  }
  bool exhausted() const { return report_.stop != StopReason::kFinished; }

 private:
  using Clock = std::chrono::steady_clock;
  void look_at_clock(std::size_t vertices, std::size_t waiting);
  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

  const RunControl& control_;
  RunReport& report_;
  Clock::time_point start_ = Clock::now(), stage_start_ = start_, last_progress_ = start_;
  const char* stage_ = nullptr;
  unsigned calls_ = 0;
};

}  // namespace delvox
