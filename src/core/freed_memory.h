#pragma once

#include <malloc.h>

namespace delvox {

/// Gives memory that has been freed back to the system: for the ends of stages that needed much more than the next one
/// does. The allocator keeps it otherwise, for blocks that may never come, and it counts as the process's.
inline void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace delvox
