#pragma once

#include <cstdint>

namespace delvox {

/// How many bytes this process may still take without swapping: what the machine has to give (MemAvailable), bounded by
/// what its container and `ulimit -v` allow.
std::uint64_t available_memory();

}  // namespace delvox
