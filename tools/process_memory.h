#pragma once

namespace delvox::tools {

/// What this process holds in memory, bytes: now, and at most since it began.
struct ProcessMemory {
  double now = 0, peak = 0;
};

/// From /proc/self/status; zero where there is none.
ProcessMemory process_memory();

}  // namespace delvox::tools
