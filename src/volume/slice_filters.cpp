#include "volume/slice_filters.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

namespace delvox {
namespace {

using Range = tbb::blocked_range<int>;

std::size_t area_of(const VolumeSource& source) { return static_cast<std::size_t>(source.dims()[0]) * source.dims()[1]; }

/// A source made from another, whose passes are readers of type Reader.
template <class Reader, class Settings>
class FilteredSource final : public VolumeSource {
 public:
  FilteredSource(VolumeSourcePtr source, VolumeHeader header, Settings settings)
      : VolumeSource(std::move(header)), source_(std::move(source)), settings_(std::move(settings)) {}
  std::unique_ptr<SliceReader> start() const override { return std::make_unique<Reader>(source_, dims(), settings_); }

 private:
  VolumeSourcePtr source_;
  Settings settings_;
};

/// Some consecutive slices of a source.
class SliceWindow {
 public:
  explicit SliceWindow(const VolumeSource& source) : area_(area_of(source)), reader_(source.start()) {}

  /// Reads on until slice `end` - 1 is there; returns the first that is new.
  int extend(int end) {
    const int first = begin_ + static_cast<int>(slices_.size());
    for (int k = first; k < end; ++k) {
      slices_.emplace_back(area_);
      reader_->read(1, slices_.back().data());
    }
    return first;
  }
  void drop_before(int k) {
    for (; begin_ < k && !slices_.empty(); ++begin_) slices_.pop_front();
  }
  float* slice(int k) { return slices_[static_cast<std::size_t>(k - begin_)].data(); }
  std::vector<std::string> warnings() const { return reader_->warnings(); }

 private:
  std::size_t area_;
  std::unique_ptr<SliceReader> reader_;
  std::deque<std::vector<float>> slices_;
  int begin_ = 0;
};

/// Weights at distance 0, 1, ... from the middle: the kernel is symmetric.
std::vector<double> half_gaussian(double sigma) {
  const int radius = static_cast<int>(4 * sigma + 0.5);
  std::vector<double> weights(static_cast<std::size_t>(radius) + 1);
  double sum = 0;
  for (int t = radius; t >= 0; --t) {  // small ones first
    const double weight = std::exp(-0.5 * (t / sigma) * (t / sigma));
    weights[static_cast<std::size_t>(t)] = weight;
    sum += t == 0 ? weight : 2 * weight;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// acc += weight * (a + b), the loop that everything is spent in.
void add_pair(double* acc, const float* a, const float* b, double weight, int count) {
  for (int i = 0; i < count; ++i) acc[i] += weight * (static_cast<double>(a[i]) + static_cast<double>(b[i]));
}

/// Smooths one row of n samples in place.
void smooth_row(float* samples, int n, const std::vector<double>& weights, std::vector<float>& padded, double* acc) {
  const int radius = static_cast<int>(weights.size()) - 1;
  padded.resize(static_cast<std::size_t>(n) + 2 * radius);
  std::fill_n(padded.begin(), radius, samples[0]);
  std::copy_n(samples, n, padded.begin() + radius);
  std::fill_n(padded.begin() + radius + n, radius, samples[n - 1]);
  const float* middle = padded.data() + radius;
  for (int i = 0; i < n; ++i) acc[i] = weights[0] * middle[i];
  for (int t = 1; t <= radius; ++t) add_pair(acc, middle - t, middle + t, weights[t], n);
  for (int i = 0; i < n; ++i) samples[i] = static_cast<float>(acc[i]);
}

/// One row of `width` samples smoothed across rows: row(n) is row n, the last of `count` repeated beyond them.
template <class Row>
void smooth_across(const Row& row, int n, int count, int width, const std::vector<double>& weights, double* acc,
                   float* out) {
  const auto clamped = [&](int m) { return row(std::clamp(m, 0, count - 1)); };
  const float* middle = row(n);
  for (int i = 0; i < width; ++i) acc[i] = weights[0] * middle[i];
  for (int t = 1; t < static_cast<int>(weights.size()); ++t) {
    add_pair(acc, clamped(n - t), clamped(n + t), weights[t], width);
  }
  for (int i = 0; i < width; ++i) out[i] = static_cast<float>(acc[i]);
}

/// Half kernels along i, j, k; of one weight where there is nothing to do.
using Kernels = std::array<std::vector<double>, 3>;

class SmoothedReader final : public SliceReader {
 public:
  SmoothedReader(const VolumeSourcePtr& source, const std::array<int, 3>& dims, const Kernels& kernels)
      : dims_(dims), kernels_(kernels), window_(*source), radius_(static_cast<int>(kernels[2].size()) - 1) {}

  void read(int count, float* out) override {
    const int end = std::min(next_ + count + radius_, dims_[2]);
    const int first_new = window_.extend(end);
    tbb::parallel_for(first_new, end, [&](int k) { smooth_slice(window_.slice(k)); });
    const std::size_t row = dims_[0], area = row * dims_[1];
    tbb::parallel_for(Range(0, dims_[1]), [&](const Range& rows) {
      std::vector<double> acc(row);
      for (int n = 0; n < count; ++n) {
        for (int j = rows.begin(); j != rows.end(); ++j) {
          const auto across = [&](int k) { return window_.slice(k) + j * row; };
          smooth_across(across, next_ + n, dims_[2], dims_[0], kernels_[2], acc.data(), out + n * area + j * row);
        }
      }
    });
    next_ += count;
    window_.drop_before(next_ - radius_);
  }
  std::vector<std::string> warnings() const override { return window_.warnings(); }

 private:
  void smooth_slice(float* slice) const {
    const std::size_t row = dims_[0];
    std::vector<double> acc(row);
    if (kernels_[0].size() > 1) {
      std::vector<float> padded;
      for (int j = 0; j < dims_[1]; ++j) smooth_row(slice + j * row, dims_[0], kernels_[0], padded, acc.data());
    }
    if (kernels_[1].size() > 1) {
      const std::vector<float> source(slice, slice + row * dims_[1]);
      const auto across = [&](int j) { return source.data() + j * row; };
      for (int j = 0; j < dims_[1]; ++j) {
        smooth_across(across, j, dims_[1], dims_[0], kernels_[1], acc.data(), slice + j * row);
      }
    }
  }

  std::array<int, 3> dims_;
  const Kernels& kernels_;
  SliceWindow window_;
  int radius_;
  int next_ = 0;
};

/// Where one new sample comes from along one axis: (1 - fraction) * [below] + fraction * [above].
struct Tap {
  int below, above;
  double fraction;
};
using Taps = std::array<std::vector<Tap>, 3>;

std::vector<Tap> make_taps(int dims, int new_dims, double offset, double step) {
  std::vector<Tap> taps(static_cast<std::size_t>(new_dims));
  for (int n = 0; n < new_dims; ++n) {
    const double position = std::clamp(offset + n * step, 0.0, static_cast<double>(dims - 1));
    const int below = static_cast<int>(position);
    taps[n] = {below, std::min(below + 1, dims - 1), position - below};
  }
  return taps;
}

class InterpolatedReader final : public SliceReader {
 public:
  InterpolatedReader(const VolumeSourcePtr& source, const std::array<int, 3>& dims, const Taps& taps)
      : dims_(dims), old_row_(source->dims()[0]), taps_(taps), window_(*source) {}

  void read(int count, float* out) override {
    window_.extend(taps_[2][next_ + count - 1].above + 1);
    const std::size_t row = dims_[0], area = row * dims_[1];
    tbb::parallel_for(Range(0, dims_[1]), [&](const Range& rows) {
      std::vector<double> blended(static_cast<std::size_t>(old_row_));
      for (int n = 0; n < count; ++n) {
        for (int j = rows.begin(); j != rows.end(); ++j) {
          interpolate_row(taps_[1][j], taps_[2][next_ + n], blended.data(), out + n * area + j * row);
        }
      }
    });
    next_ += count;
    if (next_ < dims_[2]) window_.drop_before(taps_[2][next_].below);
  }
  std::vector<std::string> warnings() const override { return window_.warnings(); }

 private:
  void interpolate_row(const Tap& y, const Tap& z, double* blended, float* out) {
    const auto row = [&](int j, int k) { return window_.slice(k) + static_cast<std::size_t>(j) * old_row_; };
    const float *a = row(y.below, z.below), *b = row(y.above, z.below);
    const float *c = row(y.below, z.above), *d = row(y.above, z.above);
    const double wa = (1 - y.fraction) * (1 - z.fraction), wb = y.fraction * (1 - z.fraction);
    const double wc = (1 - y.fraction) * z.fraction, wd = y.fraction * z.fraction;
    for (int i = 0; i < old_row_; ++i) blended[i] = wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i];
    for (const Tap& x : taps_[0]) {
      *out++ = static_cast<float>((1 - x.fraction) * blended[x.below] + x.fraction * blended[x.above]);
    }
  }

  std::array<int, 3> dims_;
  int old_row_;
  const Taps& taps_;
  SliceWindow window_;
  int next_ = 0;
};

class CroppedReader final : public SliceReader {
 public:
  CroppedReader(const VolumeSourcePtr& source, const std::array<int, 3>& dims, const std::array<int, 3>& begin)
      : dims_(dims), begin_(begin), old_row_(source->dims()[0]), window_(*source), next_(begin[2]) {
    for (int k = 0; k < next_; ++k) {
      window_.extend(k + 1);
      window_.drop_before(k + 1);
    }
  }

  void read(int count, float* out) override {
    for (int n = 0; n < count; ++n, ++next_) {
      window_.extend(next_ + 1);
      for (int j = 0; j < dims_[1]; ++j, out += dims_[0]) {
        std::copy_n(window_.slice(next_) + (begin_[1] + j) * old_row_ + begin_[0], dims_[0], out);
      }
      window_.drop_before(next_ + 1);
    }
  }
  std::vector<std::string> warnings() const override { return window_.warnings(); }

 private:
  std::array<int, 3> dims_, begin_;
  std::size_t old_row_;
  SliceWindow window_;
  int next_;
};

}  // namespace

VolumeSourcePtr smoothed(VolumeSourcePtr source, const std::array<double, 3>& sigmas) {
  Kernels kernels;
  bool anything = false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool wanted = sigmas[axis] > 0 && source->dims()[axis] > 1;
    kernels[axis] = wanted ? half_gaussian(sigmas[axis]) : std::vector<double>{1};
    anything |= kernels[axis].size() > 1;
  }
  if (!anything) return source;
  VolumeHeader header = source->header();
  return std::make_shared<FilteredSource<SmoothedReader, Kernels>>(std::move(source), std::move(header),
                                                                   std::move(kernels));
}

VolumeSourcePtr interpolated(VolumeSourcePtr source, VolumeHeader header, const std::array<double, 3>& offset,
                             const std::array<double, 3>& step) {
  Taps taps;
  for (int axis = 0; axis < 3; ++axis) {
    taps[axis] = make_taps(source->dims()[axis], header.dims[axis], offset[axis], step[axis]);
  }
  return std::make_shared<FilteredSource<InterpolatedReader, Taps>>(std::move(source), std::move(header),
                                                                    std::move(taps));
}

VolumeSourcePtr cropped(VolumeSourcePtr source, VolumeHeader header, const std::array<int, 3>& begin) {
  return std::make_shared<FilteredSource<CroppedReader, std::array<int, 3>>>(std::move(source), std::move(header),
                                                                             begin);
}

}  // namespace delvox
