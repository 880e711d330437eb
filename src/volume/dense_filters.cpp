#include "volume/dense_filters.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace delvox {
namespace {

using Range = tbb::blocked_range<int>;

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

/// Smooths along i, row by row, in place.
void smooth_rows(DenseGrid& grid, const std::vector<double>& weights) {
  const int n = grid.dims[0], radius = static_cast<int>(weights.size()) - 1;
  tbb::parallel_for(Range(0, grid.dims[1] * grid.dims[2], 64), [&](const Range& rows) {
    std::vector<float> padded(static_cast<std::size_t>(n) + 2 * radius);
    std::vector<double> acc(static_cast<std::size_t>(n));
    for (int row = rows.begin(); row != rows.end(); ++row) {
      float* samples = grid.samples.data() + static_cast<std::size_t>(row) * n;
      std::fill_n(padded.begin(), radius, samples[0]);
      std::copy_n(samples, n, padded.begin() + radius);
      std::fill_n(padded.begin() + radius + n, radius, samples[n - 1]);
      const float* middle = padded.data() + radius;
      for (int i = 0; i < n; ++i) acc[i] = weights[0] * middle[i];
      for (int t = 1; t <= radius; ++t) add_pair(acc.data(), middle - t, middle + t, weights[t], n);
      for (int i = 0; i < n; ++i) samples[i] = static_cast<float>(acc[i]);
    }
  });
}

/// Smooths across rows: `source` and `target` are `count` rows of `width` samples, `stride` apart.
void smooth_across_rows(const float* source, float* target, std::size_t stride, int count, int width,
                        const std::vector<double>& weights) {
  const int radius = static_cast<int>(weights.size()) - 1;
  std::vector<double> acc(static_cast<std::size_t>(width));
  const auto row = [&](int n) { return source + static_cast<std::size_t>(std::clamp(n, 0, count - 1)) * stride; };
  for (int n = 0; n < count; ++n) {
    const float* middle = row(n);
    for (int i = 0; i < width; ++i) acc[i] = weights[0] * middle[i];
    for (int t = 1; t <= radius; ++t) add_pair(acc.data(), row(n - t), row(n + t), weights[t], width);
    float* out = target + static_cast<std::size_t>(n) * stride;
    for (int i = 0; i < width; ++i) out[i] = static_cast<float>(acc[i]);
  }
}

/// Smooths along j, slice by slice.
void smooth_columns(DenseGrid& grid, const std::vector<double>& weights) {
  const std::size_t slice = static_cast<std::size_t>(grid.dims[0]) * grid.dims[1];
  tbb::parallel_for(Range(0, grid.dims[2]), [&](const Range& slices) {
    std::vector<float> source(slice);
    for (int k = slices.begin(); k != slices.end(); ++k) {
      float* target = grid.samples.data() + static_cast<std::size_t>(k) * slice;
      std::copy_n(target, slice, source.begin());
      smooth_across_rows(source.data(), target, grid.dims[0], grid.dims[1], grid.dims[0], weights);
    }
  });
}

/// Smooths along k, one j at a time.
void smooth_slices(DenseGrid& grid, const std::vector<double>& weights) {
  const std::size_t n = grid.dims[0], slice = n * grid.dims[1];
  tbb::parallel_for(Range(0, grid.dims[1]), [&](const Range& columns) {
    const std::size_t depth = static_cast<std::size_t>(grid.dims[2]);
    std::vector<float> source(n * depth), target(n * depth);
    for (int j = columns.begin(); j != columns.end(); ++j) {
      float* samples = grid.samples.data() + static_cast<std::size_t>(j) * n;
      for (std::size_t k = 0; k < depth; ++k) std::copy_n(samples + k * slice, n, source.begin() + k * n);
      smooth_across_rows(source.data(), target.data(), n, grid.dims[2], grid.dims[0], weights);
      for (std::size_t k = 0; k < depth; ++k) std::copy_n(target.begin() + k * n, n, samples + k * slice);
    }
  });
}

/// Where one new sample comes from along one axis: (1 - fraction) * [below] + fraction * [above].
struct Tap {
  int below, above;
  double fraction;
};

std::vector<Tap> make_taps(int dims, int new_dims, double offset, double step) {
  std::vector<Tap> taps(static_cast<std::size_t>(new_dims));
  for (int n = 0; n < new_dims; ++n) {
    const double position = std::clamp(offset + n * step, 0.0, static_cast<double>(dims - 1));
    const int below = static_cast<int>(position);
    taps[n] = {below, std::min(below + 1, dims - 1), position - below};
  }
  return taps;
}

}  // namespace

void smooth_grid(DenseGrid& grid, const std::array<double, 3>& sigmas) {
  using Pass = void (*)(DenseGrid&, const std::vector<double>&);
  constexpr Pass kPasses[3] = {smooth_rows, smooth_columns, smooth_slices};
  for (int axis = 0; axis < 3; ++axis) {
    if (sigmas[axis] <= 0 || grid.dims[axis] == 1) continue;
    const std::vector<double> weights = half_gaussian(sigmas[axis]);
    if (weights.size() > 1) kPasses[axis](grid, weights);
  }
}

DenseGrid interpolate_grid(const DenseGrid& grid, const std::array<int, 3>& dims, const std::array<double, 3>& offset,
                           const std::array<double, 3>& step) {
  std::array<std::vector<Tap>, 3> taps;
  for (int axis = 0; axis < 3; ++axis) taps[axis] = make_taps(grid.dims[axis], dims[axis], offset[axis], step[axis]);
  DenseGrid result;
  result.dims = dims;
  const std::size_t new_row = static_cast<std::size_t>(dims[0]), new_slice = new_row * dims[1];
  result.samples.resize(new_slice * dims[2]);
  const int n = grid.dims[0];
  const auto row = [&](int j, int k) {
    return grid.samples.data() + (static_cast<std::size_t>(k) * grid.dims[1] + j) * n;
  };
  tbb::parallel_for(Range(0, dims[2]), [&](const Range& slices) {
    std::vector<double> blended(static_cast<std::size_t>(n));
    for (int k = slices.begin(); k != slices.end(); ++k) {
      const Tap& z = taps[2][k];
      for (int j = 0; j < dims[1]; ++j) {
        const Tap& y = taps[1][j];
        const float *a = row(y.below, z.below), *b = row(y.above, z.below);
        const float *c = row(y.below, z.above), *d = row(y.above, z.above);
        const double wa = (1 - y.fraction) * (1 - z.fraction), wb = y.fraction * (1 - z.fraction);
        const double wc = (1 - y.fraction) * z.fraction, wd = y.fraction * z.fraction;
        for (int i = 0; i < n; ++i) blended[i] = wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i];
        float* out = result.samples.data() + static_cast<std::size_t>(k) * new_slice + j * new_row;
        for (std::size_t i = 0; i < new_row; ++i) {
          const Tap& x = taps[0][i];
          out[i] = static_cast<float>((1 - x.fraction) * blended[x.below] + x.fraction * blended[x.above]);
        }
      }
    }
  });
  return result;
}

}  // namespace delvox
