#include "thread_limit.h"

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>

namespace delvox::tools {

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(CLI::App& app) {
  const auto limit = [this](std::size_t threads) {
    control_.reset(new Control{tbb::global_control(tbb::global_control::max_allowed_parallelism, threads)});
  };
  app.add_option_function<std::size_t>("--threads", limit, "How many threads to use (default: all cores)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
}

ThreadLimit::~ThreadLimit() = default;

std::size_t threads_in_use() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace delvox::tools
