#pragma once

#include <array>

#include "delvox/volume/volume_source.h"

namespace delvox {

// Sources made from others. Each keeps no more slices than it needs at a time.

/// Gaussian of `sigmas` voxels along i, j, k, truncated at 4 sigma (rounded to voxels, as scipy does), normalised,
/// edges repeated. A sigma of 0, and any sigma along an axis with one voxel, does nothing.
VolumeSourcePtr smoothed(VolumeSourcePtr source, const std::array<double, 3>& sigmas);

/// Trilinear samples at i = offset + n * step along each axis, n from 0 to header.dims - 1; edges repeated outside.
VolumeSourcePtr interpolated(VolumeSourcePtr source, VolumeHeader header, const std::array<double, 3>& offset,
                             const std::array<double, 3>& step);

/// The voxels from `begin` on, as many as header.dims. pre: they lie in the source.
VolumeSourcePtr cropped(VolumeSourcePtr source, VolumeHeader header, const std::array<int, 3>& begin);

}  // namespace delvox
