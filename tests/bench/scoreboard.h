#pragma once

#include <string>
#include <vector>

#include "isolated.h"

namespace delvox::bench {

/// One contender and its runs.
struct Column {
  std::string name;
  bool bulk = false;  ///< makes no mesh: only time, cells and memory mean anything
  std::vector<Outcome> runs;
};

/// The outcome with the median wall-clock time. pre: at least one run.
const Outcome& median_run(const Column& column);

/// Contenders side by side, one quantity per line, as a Markdown table. Ratios are against the column "delvox", if any.
std::string scoreboard(const std::vector<Column>& columns);

/// One sentence: delvox against the fastest of CGAL's tags. Empty if either is missing or failed.
std::string verdict(const std::vector<Column>& columns);

}  // namespace delvox::bench
