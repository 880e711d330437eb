#pragma once

#include <array>
#include <vector>

namespace delvox {

/// A dense grid of samples, i fastest.
struct DenseGrid {
  std::array<int, 3> dims{0, 0, 0};
  std::vector<float> samples;
};

/// Gaussian of `sigmas` voxels along i, j, k, truncated at 4 sigma (rounded to voxels, as scipy does), normalised,
/// edges repeated. A sigma of 0, and any sigma along an axis with one voxel, does nothing.
void smooth_grid(DenseGrid& grid, const std::array<double, 3>& sigmas);

/// Trilinear samples at i = offset + n * step along each axis, n from 0 to dims - 1; edges repeated outside.
DenseGrid interpolate_grid(const DenseGrid& grid, const std::array<int, 3>& dims, const std::array<double, 3>& offset,
                           const std::array<double, 3>& step);

}  // namespace delvox
