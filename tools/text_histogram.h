#pragma once

#include <string>
#include <vector>

#include "delvox/volume/histogram.h"

namespace delvox::tools {

/// A histogram as lines of text: eight rows of columns, one per bin, heights logarithmic in the counts; below it the
/// places of `marks`, and the range.
std::string text_histogram(const Histogram& histogram, const std::vector<double>& marks);

}  // namespace delvox::tools
