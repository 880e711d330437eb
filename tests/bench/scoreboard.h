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

/// The names of what csv_rows gives, after those of the setting.
std::string csv_names();
/// A line of comma-separated values for each contender that did not fail, after `setting`: medians, ranges, counts.
std::string csv_rows(const std::vector<Column>& columns, const std::string& setting);

/// One sentence: delvox against the fastest of CGAL's tags. Empty if either is missing or failed.
std::string verdict(const std::vector<Column>& columns);

}  // namespace delvox::bench
