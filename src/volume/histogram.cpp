#include "delvox/volume/histogram.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

constexpr std::size_t kMaxBins = 65536;
using Counts = std::vector<std::size_t>;
using Range = tbb::blocked_range<std::size_t>;

void require_samples(std::span<const float> samples) {
  if (samples.empty()) throw OptionError("histogram: there are no samples; give a volume with at least one voxel");
}

/// Calls visit(sample, counts) for all samples, a private `counts` per thread, and adds those up: whole numbers, so the
/// order of threads does not show.
template <typename Visit>
Counts count_samples(std::span<const float> samples, std::size_t bins, Visit visit) {
  tbb::enumerable_thread_specific<Counts> partial(Counts(bins, 0));
  tbb::parallel_for(Range(0, samples.size(), 1 << 18), [&](const Range& range) {
    Counts& counts = partial.local();
    for (std::size_t i = range.begin(); i != range.end(); ++i) visit(samples[i], counts);
  });
  Counts total(bins, 0);
  for (const Counts& counts : partial) {
    for (std::size_t bin = 0; bin < bins; ++bin) total[bin] += counts[bin];
  }
  return total;
}

struct Extremes {
  float low = std::numeric_limits<float>::infinity();
  float high = -std::numeric_limits<float>::infinity();
  bool integers = true;
};

Extremes find_extremes(std::span<const float> samples) {
  tbb::enumerable_thread_specific<Extremes> partial;
  tbb::parallel_for(Range(0, samples.size(), 1 << 18), [&](const Range& range) {
    Extremes found = partial.local();
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const float sample = samples[i];
      found.low = sample < found.low ? sample : found.low;
      found.high = sample > found.high ? sample : found.high;
      found.integers = found.integers && sample == std::trunc(sample);
    }
    partial.local() = found;
  });
  Extremes all;
  for (const Extremes& found : partial) {
    all.low = std::min(all.low, found.low);
    all.high = std::max(all.high, found.high);
    all.integers = all.integers && found.integers;
  }
  return all;
}

/// Bits of a float as a number that sorts like the float.
std::uint32_t sortable(float sample) {
  const auto bits = std::bit_cast<std::uint32_t>(sample);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
float unsortable(std::uint32_t key) {
  return std::bit_cast<float>(key & 0x80000000u ? key & 0x7FFFFFFFu : ~key);
}

/// The bin that holds the sample of this rank, and the rank within the bin.
struct Place {
  std::size_t bin;
  std::size_t rank;
};
Place find_rank(const Counts& counts, std::size_t begin, std::size_t rank) {
  std::size_t bin = begin;
  while (rank >= counts[bin]) rank -= counts[bin++];
  return {bin - begin, rank};
}

/// The samples of the given ranks in sorted order, by two rounds of counting, 16 bits each, instead of sorting.
std::vector<float> select_ranks(std::span<const float> samples, const std::vector<std::size_t>& ranks) {
  const Counts upper = count_samples(samples, kMaxBins, [](float s, Counts& counts) { ++counts[sortable(s) >> 16]; });
  constexpr std::int32_t kNone = -1;
  std::vector<std::int32_t> slot_of(kMaxBins, kNone);
  std::size_t slots = 0;
  std::vector<Place> places;
  for (std::size_t rank : ranks) {
    places.push_back(find_rank(upper, 0, rank));
    std::int32_t& slot = slot_of[places.back().bin];
    if (slot == kNone) slot = static_cast<std::int32_t>(slots++);
  }
  const Counts lower = count_samples(samples, slots * kMaxBins, [&](float s, Counts& counts) {
    const std::uint32_t key = sortable(s);
    const std::int32_t slot = slot_of[key >> 16];
    if (slot != kNone) ++counts[static_cast<std::size_t>(slot) * kMaxBins + (key & 0xFFFFu)];
  });
  std::vector<float> result;
  for (const Place& place : places) {
    const Place exact = find_rank(lower, static_cast<std::size_t>(slot_of[place.bin]) * kMaxBins, place.rank);
    result.push_back(unsortable(static_cast<std::uint32_t>(place.bin << 16 | exact.bin)));
  }
  return result;
}

/// Occupied bins in ascending order; position * step + origin is the value that a bin stands for.
struct OccupiedBins {
  double origin = 0;
  double step = 1;
  std::vector<double> position;
  std::vector<double> weight;
};

OccupiedBins occupied_bins(std::span<const float> samples) {
  const Extremes extremes = find_extremes(samples);
  const double low = extremes.low, range = static_cast<double>(extremes.high) - low;
  const bool one_bin_per_integer = range == 0 || (extremes.integers && range < kMaxBins);
  OccupiedBins bins;
  Counts counts;
  if (one_bin_per_integer) {
    bins.origin = low;
    counts = count_samples(samples, kMaxBins,
                           [low](float s, Counts& c) { ++c[static_cast<std::size_t>(s - low)]; });
  } else {
    bins.step = range / kMaxBins;
    bins.origin = low + 0.5 * bins.step;
    counts = count_samples(samples, kMaxBins, [low, scale = kMaxBins / range](float s, Counts& c) {
      ++c[std::min(static_cast<std::size_t>((s - low) * scale), kMaxBins - 1)];
    });
  }
  for (std::size_t bin = 0; bin < kMaxBins; ++bin) {
    if (counts[bin] == 0) continue;
    bins.position.push_back(static_cast<double>(bin));
    bins.weight.push_back(static_cast<double>(counts[bin]));
  }
  return bins;
}

/// Least variance within classes = largest sum over classes of (sum of values)^2 / weight, by dynamic programming over
/// the bins; the best split moves up with the end of the range, which divide and conquer uses: O(classes n log n).
class ClassSplitter {
 public:
  explicit ClassSplitter(const OccupiedBins& bins) : size_(bins.position.size()), weights_{0}, sums_{0} {
    for (std::size_t i = 0; i < size_; ++i) {
      weights_.push_back(weights_.back() + bins.weight[i]);
      sums_.push_back(sums_.back() + bins.weight[i] * bins.position[i]);
    }
  }

  /// First bin of each class but the lowest. pre: 2 <= classes <= number of bins.
  std::vector<std::size_t> split(std::size_t classes) {
    best_.assign(size_ + 1, 0);
    for (std::size_t end = 1; end <= size_; ++end) best_[end] = gain(0, end);
    std::vector<std::vector<std::size_t>> first_of_last(classes + 1);
    for (std::size_t c = 2; c <= classes; ++c) {
      next_.assign(size_ + 1, 0);
      first_.assign(size_ + 1, 0);
      extend(c, size_, c - 1, size_ - 1);
      best_.swap(next_);
      first_of_last[c] = first_;
    }
    std::vector<std::size_t> firsts;
    for (std::size_t c = classes, end = size_; c >= 2; --c) {
      end = first_of_last[c][end];
      firsts.push_back(end);
    }
    std::reverse(firsts.begin(), firsts.end());
    return firsts;
  }

 private:
  double gain(std::size_t begin, std::size_t end) const {
    const double sum = sums_[end] - sums_[begin];
    return sum * sum / (weights_[end] - weights_[begin]);
  }

  /// Adds one class to the best splits of bins [0, end) for all ends in [low_end, high_end], knowing that its first bin
  /// lies in [low, high].
  void extend(std::size_t low_end, std::size_t high_end, std::size_t low, std::size_t high) {
    if (low_end > high_end) return;
    const std::size_t end = low_end + (high_end - low_end) / 2;
    std::size_t best_first = low;
    double best_value = -1;
    for (std::size_t first = low; first <= std::min(high, end - 1); ++first) {
      const double value = best_[first] + gain(first, end);
      if (value > best_value) {
        best_value = value;
        best_first = first;
      }
    }
    next_[end] = best_value;
    first_[end] = best_first;
    extend(low_end, end - 1, low, best_first);
    extend(end + 1, high_end, best_first, high);
  }

  std::size_t size_;
  std::vector<double> weights_, sums_, best_, next_;
  std::vector<std::size_t> first_;
};

}  // namespace

Histogram make_histogram(std::span<const float> samples, int bins) {
  require_samples(samples);
  if (bins < 1) throw OptionError("histogram: the number of bins is below 1; give a positive number");
  const Extremes extremes = find_extremes(samples);
  Histogram histogram{extremes.low, extremes.high, {}};
  const std::size_t count = static_cast<std::size_t>(bins);
  const double range = histogram.high - histogram.low;
  const double scale = range > 0 ? bins / range : 0;
  histogram.counts = count_samples(samples, count, [low = histogram.low, scale, count](float s, Counts& counts) {
    ++counts[std::min(static_cast<std::size_t>((s - low) * scale), count - 1)];
  });
  return histogram;
}

std::vector<double> percentiles(std::span<const float> samples, std::span<const double> percents) {
  require_samples(samples);
  std::vector<std::size_t> ranks;
  std::vector<double> fractions;
  for (double percent : percents) {
    if (!(percent >= 0 && percent <= 100)) throw OptionError("percentile: must be from 0 to 100");
    const double rank = percent / 100 * static_cast<double>(samples.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(rank), samples.size() - 1);
    ranks.push_back(below);
    ranks.push_back(std::min(below + 1, samples.size() - 1));
    fractions.push_back(rank - static_cast<double>(below));
  }
  const std::vector<float> at_rank = select_ranks(samples, ranks);
  std::vector<double> result;
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    const double below = at_rank[2 * i], above = at_rank[2 * i + 1];
    result.push_back(below + fractions[i] * (above - below));
  }
  return result;
}

std::vector<double> otsu_isovalues(std::span<const float> samples, int classes) {
  require_samples(samples);
  if (classes < 2) throw OptionError("otsu: needs at least 2 classes");
  const OccupiedBins bins = occupied_bins(samples);
  if (bins.position.size() < static_cast<std::size_t>(classes)) return {};
  std::vector<double> result;
  for (std::size_t first : ClassSplitter(bins).split(static_cast<std::size_t>(classes))) {
    result.push_back(bins.origin + bins.step * 0.5 * (bins.position[first - 1] + bins.position[first]));
  }
  return result;
}

}  // namespace delvox
