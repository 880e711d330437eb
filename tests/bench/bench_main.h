#pragma once

#include <exception>
#include <functional>
#include <iostream>

namespace delvox::bench {

/// The exit code of a benchmark: what `run` returns; 2, after one line that names it, if it throws.
inline int exit_code_of(const char* name, const std::function<int()>& run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return 2;
  }
}

}  // namespace delvox::bench
