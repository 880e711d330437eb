#include "meshing/run_budget.h"

#include "delvox/core/errors.h"

namespace delvox {

RunBudget::RunBudget(const RunControl& control, RunReport& report) : control_(control), report_(report) {}

void RunBudget::begin_stage(const char* stage) {
  end_stage();
  stage_ = stage;
  stage_start_ = Clock::now();
}

void RunBudget::end_stage() {
  if (stage_ == nullptr) return;
  const double seconds = seconds_since(stage_start_);
  for (StageTime& known : report_.stages) {
    if (known.stage == stage_) {
      known.seconds += seconds;
      stage_ = nullptr;
      return;
    }
  }
  report_.stages.push_back({stage_, seconds});
  stage_ = nullptr;
}

bool RunBudget::go_on(std::size_t vertices, std::size_t waiting) {
  if (exhausted()) return false;
  if (control_.limits.max_vertices != 0 && vertices >= control_.limits.max_vertices) {
    report_.stop = StopReason::kMaxVertices;
    return false;
  }
  constexpr unsigned kCallsPerLook = 256;  // the clock costs more than an insertion's bookkeeping
  if (calls_++ % kCallsPerLook == 0) look_at_clock(vertices, waiting);
  return !exhausted();
}

void RunBudget::look_at_clock(std::size_t vertices, std::size_t waiting) {
  if (control_.cancel != nullptr && control_.cancel->load(std::memory_order_relaxed)) throw Cancelled();
  if (control_.limits.max_seconds > 0 && seconds_since(start_) > control_.limits.max_seconds) {
    report_.stop = StopReason::kMaxSeconds;
  }
  constexpr double kSecondsPerProgress = 0.1;
  if (control_.on_progress && seconds_since(last_progress_) > kSecondsPerProgress) {
    last_progress_ = Clock::now();
    control_.on_progress({stage_ != nullptr ? stage_ : "", vertices, waiting});
  }
}

}  // namespace delvox
