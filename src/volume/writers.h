#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "delvox/volume/volume_source.h"

namespace delvox {

/// One writer per format; see write_volume.
void write_nifti(const Volume& volume, const std::filesystem::path& path, bool compressed);
void write_tiff(const VolumeSource& volume, const std::filesystem::path& path);
void write_raw_json(const Volume& volume, const std::filesystem::path& path);
void write_vdb(const Volume& volume, const std::filesystem::path& path);

/// Calls action(samples, first_k, count) for consecutive slabs of slices, so that no dense copy of all is needed.
template <class Action>
void for_each_slab(const Volume& volume, const Action& action) {
  constexpr int kSlices = 8;  // OpenVDB's leaves are 8 thick: each is visited once
  const std::array<int, 3>& dims = volume.dims();
  const std::size_t slice = static_cast<std::size_t>(dims[0]) * dims[1];
  std::vector<float> samples(slice * std::min(kSlices, dims[2]));
  for (int k = 0; k < dims[2]; k += kSlices) {
    const int slices = std::min(kSlices, dims[2] - k);
    volume.copy_block({0, 0, k}, {dims[0], dims[1], slices}, samples.data());
    action(static_cast<const float*>(samples.data()), k, slice * slices);
  }
}

}  // namespace delvox
