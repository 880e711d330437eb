#include "text_histogram.h"

#include <algorithm>
#include <cmath>

#include "format.h"

namespace delvox::tools {
namespace {

constexpr int kRows = 8;
constexpr int kSteps = 8;  // of one character cell
const char* const kBlocks[kSteps + 1] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};

// Height of a column in eighths of a cell; every bin with a sample shows.
int height(std::size_t count, std::size_t fullest) {
  if (count == 0) return 0;
  const double share = std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(fullest));
  return std::max(1, static_cast<int>(std::lround(share * kRows * kSteps)));
}

}  // namespace

std::string text_histogram(const Histogram& histogram, const std::vector<double>& marks) {
  const std::size_t fullest = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  std::string text = "samples per bin, logarithmic; the fullest holds " + grouped(fullest) + "\n";
  for (int row = kRows - 1; row >= 0; --row) {
    std::string line;
    for (std::size_t count : histogram.counts) {
      line += kBlocks[std::clamp(height(count, fullest) - row * kSteps, 0, kSteps)];
    }
    text += line + "\n";
  }
  std::string ruler(histogram.counts.size(), '-');
  for (double mark : marks) {
    const double bin = (mark - histogram.low) / histogram.bin_width();
    if (bin >= 0 && bin < static_cast<double>(ruler.size())) ruler[static_cast<std::size_t>(bin)] = '^';
  }
  const std::string low = number(histogram.low, 6), high = number(histogram.high, 6);
  std::string range = low;
  range.resize(std::max(low.size() + 1, ruler.size() - std::min(ruler.size(), high.size())), ' ');
  return text + ruler + "  ^ suggested isovalues\n" + range + high + "\n";
}

}  // namespace delvox::tools
