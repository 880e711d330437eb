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
constexpr std::size_t kNoBin = std::numeric_limits<std::size_t>::max();
using Counts = std::vector<std::size_t>;
using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t kGrain = std::size_t{1} << 18;

constexpr int kCensusBegin = -32768, kCensusEnd = 65536;

struct Tally {
  float low = std::numeric_limits<float>::infinity();
  float high = -std::numeric_limits<float>::infinity();
  bool integers = true;
  Counts census = Counts(kCensusEnd - kCensusBegin, 0);  // empty once it has failed
};

void add(std::span<const float> samples, Tally& tally) {
  float low = tally.low, high = tally.high;
  bool integers = tally.integers;
  for (const float sample : samples) {
    low = sample < low ? sample : low;
    high = sample > high ? sample : high;
    integers = integers && sample == std::trunc(sample);
  }
  tally.low = low;
  tally.high = high;
  tally.integers = integers;
  if (!integers || low < kCensusBegin || high >= kCensusEnd) tally.census.clear();
  if (tally.census.empty()) return;
  // Runs of one value are counted apart: adding to the same place over and over is slow.
  float value = samples.front();
  std::size_t run = 0;
  const auto end_run = [&] { tally.census[static_cast<std::size_t>(static_cast<int>(value) - kCensusBegin)] += run; };
  for (const float sample : samples) {
    if (sample != value) {
      end_run();
      value = sample;
      run = 0;
    }
    ++run;
  }
  end_run();
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

}  // namespace

/// Occupied bins in ascending order; position * step + origin is the value that a bin stands for.
struct SampleStatistics::OccupiedBins {
  double origin = 0;
  double step = 1;
  std::vector<double> position;
  std::vector<double> weight;
};

/// Least variance within classes = largest sum over classes of (sum of values)^2 / weight, by dynamic programming over
/// the bins; the best split moves up with the end of the range, which divide and conquer uses: O(classes n log n).
class SampleStatistics::ClassSplitter {
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

SampleStatistics::SampleStatistics(std::span<const float> samples)
    : for_each_piece_([samples](const Visit& visit) {
        visit(samples);
        return std::vector<std::string>();
      }), size_(samples.size()) {
  take_census();
}

SampleStatistics::SampleStatistics(const VolumeSource& source)
    : for_each_piece_([&source](const Visit& visit) {
        const std::size_t area = static_cast<std::size_t>(source.dims()[0]) * source.dims()[1];
        return for_each_slab(source, [&](const float* samples, int, int slices) { visit({samples, area * slices}); });
      }),
      size_(source.voxel_count()) {
  take_census();
}

void SampleStatistics::take_census() {
  if (size_ == 0) throw OptionError("histogram: there are no samples; give a volume with at least one voxel");
  tbb::enumerable_thread_specific<Tally> partial;
  warnings_ = for_each_piece_([&](std::span<const float> samples) {
    tbb::parallel_for(Range(0, samples.size(), kGrain), [&](const Range& range) {
      add(samples.subspan(range.begin(), range.size()), partial.local());
    });
  });
  Tally all;
  for (const Tally& tally : partial) {
    all.low = std::min(all.low, tally.low);
    all.high = std::max(all.high, tally.high);
    all.integers = all.integers && tally.integers;
    if (tally.census.empty()) all.census.clear();
    for (std::size_t bin = 0; bin < all.census.size(); ++bin) all.census[bin] += tally.census[bin];
  }
  low_ = all.low;
  high_ = all.high;
  integers_ = all.integers;
  census_ = std::move(all.census);
}

/// How many samples there are per bin; bin_of(sample) may be kNoBin. Whole numbers, so the order of threads does not
/// show.
template <class BinOf>
Counts SampleStatistics::count(std::size_t bins, const BinOf& bin_of) const {
  Counts total(bins, 0);
  if (!census_.empty()) {
    for (std::size_t n = 0; n < census_.size(); ++n) {
      if (census_[n] == 0) continue;
      const std::size_t bin = bin_of(static_cast<float>(static_cast<int>(n) + kCensusBegin));
      if (bin != kNoBin) total[bin] += census_[n];
    }
    return total;
  }
  tbb::enumerable_thread_specific<Counts> partial(Counts(bins, 0));
  for_each_piece_([&](std::span<const float> samples) {
    tbb::parallel_for(Range(0, samples.size(), kGrain), [&](const Range& range) {
      Counts& counts = partial.local();
      for (const float sample : samples.subspan(range.begin(), range.size())) {
        const std::size_t bin = bin_of(sample);
        if (bin != kNoBin) ++counts[bin];
      }
    });
  });
  for (const Counts& counts : partial) {
    for (std::size_t bin = 0; bin < bins; ++bin) total[bin] += counts[bin];
  }
  return total;
}

/// The samples of the given ranks in sorted order, by two rounds of counting, 16 bits each, instead of sorting.
std::vector<float> SampleStatistics::select_ranks(const std::vector<std::size_t>& ranks) const {
  const Counts upper = count(kMaxBins, [](float s) -> std::size_t { return sortable(s) >> 16; });
  Counts slot_of(kMaxBins, kNoBin);
  std::size_t slots = 0;
  std::vector<Place> places;
  for (std::size_t rank : ranks) {
    places.push_back(find_rank(upper, 0, rank));
    std::size_t& slot = slot_of[places.back().bin];
    if (slot == kNoBin) slot = slots++;
  }
  const Counts lower = count(slots * kMaxBins, [&](float s) -> std::size_t {
    const std::uint32_t key = sortable(s);
    const std::size_t slot = slot_of[key >> 16];
    return slot == kNoBin ? kNoBin : slot * kMaxBins + (key & 0xFFFFu);
  });
  std::vector<float> result;
  for (const Place& place : places) {
    const Place exact = find_rank(lower, slot_of[place.bin] * kMaxBins, place.rank);
    result.push_back(unsortable(static_cast<std::uint32_t>(place.bin << 16 | exact.bin)));
  }
  return result;
}

SampleStatistics::OccupiedBins SampleStatistics::occupied_bins() const {
  const double low = low_, range = static_cast<double>(high_) - low;
  const bool one_bin_per_integer = range == 0 || (integers_ && range < kMaxBins);
  OccupiedBins bins;
  Counts counts;
  if (one_bin_per_integer) {
    bins.origin = low;
    counts = count(kMaxBins, [low](float s) { return static_cast<std::size_t>(s - low); });
  } else {
    bins.step = range / kMaxBins;
    bins.origin = low + 0.5 * bins.step;
    counts = count(kMaxBins, [low, scale = kMaxBins / range](float s) {
      return std::min(static_cast<std::size_t>((s - low) * scale), kMaxBins - 1);
    });
  }
  for (std::size_t bin = 0; bin < kMaxBins; ++bin) {
    if (counts[bin] == 0) continue;
    bins.position.push_back(static_cast<double>(bin));
    bins.weight.push_back(static_cast<double>(counts[bin]));
  }
  return bins;
}

Histogram SampleStatistics::histogram(int bins) const {
  if (bins < 1) throw OptionError("histogram: the number of bins is below 1; give a positive number");
  Histogram histogram{low_, high_, {}};
  const std::size_t most = static_cast<std::size_t>(bins);
  const double range = histogram.high - histogram.low;
  const double scale = range > 0 ? bins / range : 0;
  histogram.counts = count(most, [low = histogram.low, scale, most](float s) {
    return std::min(static_cast<std::size_t>((s - low) * scale), most - 1);
  });
  return histogram;
}

std::vector<double> SampleStatistics::percentiles(std::span<const double> percents) const {
  std::vector<std::size_t> ranks;
  std::vector<double> fractions;
  for (double percent : percents) {
    if (!(percent >= 0 && percent <= 100)) throw OptionError("percentile: must be from 0 to 100");
    const double rank = percent / 100 * static_cast<double>(size_ - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(rank), size_ - 1);
    ranks.push_back(below);
    ranks.push_back(std::min(below + 1, size_ - 1));
    fractions.push_back(rank - static_cast<double>(below));
  }
  const std::vector<float> at_rank = select_ranks(ranks);
  std::vector<double> result;
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    const double below = at_rank[2 * i], above = at_rank[2 * i + 1];
    result.push_back(below + fractions[i] * (above - below));
  }
  return result;
}

/// Where a threshold lies between two bins. Midway exactly, faces of voxels with two opposite corners inside tie in
/// integer volumes: their saddles are ratios of small integers, and the surface touches itself there. This is no such
/// ratio, and no surface moves by more than 0.003 voxel for it.
constexpr double kMidway = 0.5027864;

std::vector<double> SampleStatistics::otsu_isovalues(int classes) const {
  if (classes < 2) throw OptionError("otsu: needs at least 2 classes");
  const OccupiedBins bins = occupied_bins();
  if (bins.position.size() < static_cast<std::size_t>(classes)) return {};
  std::vector<double> result;
  for (std::size_t first : ClassSplitter(bins).split(static_cast<std::size_t>(classes))) {
    const auto below = bins.position[first - 1], above = bins.position[first];
    result.push_back(bins.origin + bins.step * (below + kMidway * (above - below)));
  }
  return result;
}

}  // namespace delvox
