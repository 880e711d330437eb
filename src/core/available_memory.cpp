#include "core/available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace delvox {
namespace {

constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();

std::uint64_t page_size() { return static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)); }

std::uint64_t left(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

/// MemAvailable counts caches that the kernel would give up; where /proc is missing, all memory stands in for it.
std::uint64_t given_by_machine() {
  std::ifstream meminfo("/proc/meminfo");
  for (std::string key; meminfo >> key; meminfo.ignore(256, '\n')) {
    std::uint64_t kilobytes = 0;
    if (key == "MemAvailable:" && meminfo >> kilobytes) return kilobytes * 1024;
  }
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * page_size();
}

/// What this process holds, in address space and in memory; 0 where /proc is missing.
struct Held {
  std::uint64_t addresses = 0, resident = 0;
};

Held held() {
  std::uint64_t addresses = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> addresses >> resident;
  return {addresses * page_size(), resident * page_size()};
}

/// Of control groups, version 2, as a container sees its own; "max" is no number and means no limit. What the group uses
/// is no help: it counts the cached pages of every file read.
std::uint64_t given_by_container() {
  std::uint64_t most = 0;
  if (!(std::ifstream("/sys/fs/cgroup/memory.max") >> most)) return kUnbounded;
  return left(most, held().resident);
}

std::uint64_t given_by_ulimit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnbounded;
  return left(limit.rlim_cur, held().addresses);
}

}  // namespace

std::uint64_t available_memory() { return std::min({given_by_machine(), given_by_container(), given_by_ulimit()}); }

}  // namespace delvox
