#include "delvox/core/run.h"

#include <algorithm>

namespace delvox {

const char* to_string(StopReason reason) {
  switch (reason) {
    case StopReason::kMaxVertices: return "max-vertices reached";
    case StopReason::kMaxSeconds: return "max-seconds reached";
    case StopReason::kFinished: break;
  }
  return "finished";
}

bool RunReport::succeeded() const {
  return stop == StopReason::kFinished &&
         std::none_of(unmet.begin(), unmet.end(), [](const Unmet& u) { return u.breaks_promise; });
}

}  // namespace delvox
