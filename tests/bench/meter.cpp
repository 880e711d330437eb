#include <malloc.h>

#include <ctime>
#include <fstream>
#include <string>

#include "contender.h"

namespace delvox::bench {

namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A line of /proc/self/status, given there in kB.
double status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return 1024 * std::stod(line.substr(key.size() + 1));
  }
  return 0;
}

}  // namespace

Meter::Meter() {
  malloc_trim(0);                               // what freed inputs left behind must not be reused unseen
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak (VmHWM, that is ru_maxrss) starts again from here
  resident_ = status_bytes("RssAnon");
  wall_ = seconds_of(CLOCK_MONOTONIC);
  cpu_ = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

/// Without the program's own code, which is read in as it is run: files that are mapped stay once they are there.
double Meter::peak_bytes() const {
  return status_bytes("VmHWM") - status_bytes("RssFile") - status_bytes("RssShmem") - resident_;
}

void Meter::stop(BenchRun& run) const {
  run.cpu_seconds = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_;
  run.seconds = seconds_of(CLOCK_MONOTONIC) - wall_;
  run.peak_bytes = peak_bytes();
}

}  // namespace delvox::bench
