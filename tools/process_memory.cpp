#include "process_memory.h"

#include <fstream>
#include <string>

namespace delvox::tools {

ProcessMemory process_memory() {
  ProcessMemory memory;
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    if (key == "VmRSS:") status >> memory.now;
    if (key == "VmHWM:") status >> memory.peak;
    std::getline(status, key);
  }
  return {1024 * memory.now, 1024 * memory.peak};  // given in kB
}

}  // namespace delvox::tools
