#include "delvox/volume/preprocess.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "delvox/core/errors.h"
#include "volume/dense_filters.h"

namespace delvox {
namespace {

std::string format(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

DenseGrid dense_grid(const Volume& volume) { return {volume.dims(), volume.samples()}; }

Volume volume_of(const DenseGrid& grid, VolumeHeader header) {
  header.dims = grid.dims;
  return Volume(std::move(header), grid.samples);
}

/// Makes `origin`, an index of the old grid, the center of the first voxel.
void move_origin(Affine3& index_to_world, const Point3& origin) {
  const Point3 world = index_to_world(origin);
  for (int row = 0; row < 3; ++row) index_to_world.rows[row][3] = world[row];
}

void scale_column(Affine3& affine, int axis, double factor) {
  for (auto& row : affine.rows) row[axis] *= factor;
}

}  // namespace

Volume crop(const Volume& volume, const IndexBox& box) {
  std::array<int, 3> begin, size;
  Point3 origin;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = std::max(box.begin[axis], 0);
    const int end = std::min(box.end[axis], volume.dims()[axis]);
    if (begin[axis] >= end) {
      throw NothingToMesh("crop: nothing is left along axis " + std::string(1, "xyz"[axis]) +
                          ", which has voxels 0 to " + std::to_string(volume.dims()[axis] - 1) +
                          "; choose a range inside");
    }
    size[axis] = end - begin[axis];
    origin[axis] = begin[axis];
  }
  DenseGrid grid{size, std::vector<float>(static_cast<std::size_t>(size[0]) * size[1] * size[2])};
  volume.copy_block(begin, size, grid.samples.data());
  VolumeHeader header = volume.header();
  move_origin(header.index_to_world, origin);
  return volume_of(grid, std::move(header));
}

IndexBox index_box(const Volume& volume, const Box3& world) {
  if (world.empty()) return {};
  const Affine3 world_to_index = volume.header().index_to_world.inverse();
  Box3 indices;
  for (int corner = 0; corner < 8; ++corner) {
    indices.extend(world_to_index({corner & 1 ? world.max.x : world.min.x, corner & 2 ? world.max.y : world.min.y,
                                   corner & 4 ? world.max.z : world.min.z}));
  }
  constexpr double kRounding = 1e-6;  // voxel: a bound given at a voxel center includes it
  IndexBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double n = volume.dims()[axis];
    box.begin[axis] = static_cast<int>(std::clamp(std::ceil(indices.min[axis] - kRounding), 0.0, n));
    box.end[axis] = static_cast<int>(std::clamp(std::floor(indices.max[axis] + kRounding) + 1, 0.0, n));
  }
  return box;
}

Volume smooth(const Volume& volume, const SmoothOptions& options) {
  const double sigma = options.sigma_mm;
  const Vector3 spacing = volume.header().spacing();
  double extent = 0;
  std::array<double, 3> sigmas;
  for (int axis = 0; axis < 3; ++axis) {
    extent = std::max(extent, volume.dims()[axis] * spacing[axis]);
    sigmas[axis] = sigma / spacing[axis];
  }
  if (!(sigma >= 0 && sigma <= extent)) {
    throw OptionError("smooth: sigma " + format(sigma) + " mm must be from 0 to the extent of the image, " +
                      format(extent) + " mm; try the voxel spacing");
  }
  if (sigma == 0) return volume;
  DenseGrid grid = dense_grid(volume);
  smooth_grid(grid, sigmas);
  return volume_of(grid, volume.header());
}

Volume resample(const Volume& volume, const ResampleOptions& options) {
  constexpr double kMaxVoxels = 2147483648.0;
  constexpr double kFullWidthPerSigma = 2.3548200450309493;  // 2 sqrt(2 ln 2)
  constexpr double kRounding = 1e-6;  // of a voxel: 64 voxels of 0.1 mm are 16 of 0.4, not 17
  const double spacing_mm = options.spacing_mm;
  if (!(spacing_mm > 0) || !std::isfinite(spacing_mm)) {
    throw OptionError("resample: spacing " + format(spacing_mm) + " mm must be positive; try the smallest voxel edge");
  }
  VolumeHeader header = volume.header();
  const Vector3 spacing = header.spacing();
  std::array<int, 3> dims;
  std::array<double, 3> offset, step, sigmas;
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double n = volume.dims()[axis], old = spacing[axis];
    const double wanted = std::max(1.0, std::ceil(n * old / spacing_mm - kRounding));
    voxels *= wanted;
    if (voxels > kMaxVoxels) {
      throw OptionError("resample: " + format(spacing_mm) +
                        " mm would make more than 2^31 voxels; choose a larger one");
    }
    dims[axis] = static_cast<int>(wanted);
    step[axis] = spacing_mm / old;
    // The middles of both fields of view coincide; indices name voxel centers.
    offset[axis] = 0.5 * (n - 1) - 0.5 * (wanted - 1) * step[axis];
    sigmas[axis] = spacing_mm > old ? std::sqrt(step[axis] * step[axis] - 1) / kFullWidthPerSigma : 0;
  }
  DenseGrid grid = dense_grid(volume);
  if (options.prefilter) smooth_grid(grid, sigmas);
  move_origin(header.index_to_world, {offset[0], offset[1], offset[2]});
  for (int axis = 0; axis < 3; ++axis) scale_column(header.index_to_world, axis, step[axis]);
  return volume_of(interpolate_grid(grid, dims, offset, step), std::move(header));
}

Volume flip_axis(const Volume& volume, int axis) {
  const DenseGrid grid = dense_grid(volume);
  DenseGrid flipped{grid.dims, std::vector<float>(grid.samples.size())};
  const std::array<int, 3>& n = grid.dims;
  std::size_t next = 0;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        std::array<int, 3> from{i, j, k};
        from[axis] = n[axis] - 1 - from[axis];
        flipped.samples[next++] = grid.samples[(static_cast<std::size_t>(from[2]) * n[1] + from[1]) * n[0] + from[0]];
      }
    }
  }
  VolumeHeader header = volume.header();
  Point3 last{};
  last[axis] = n[axis] - 1;
  move_origin(header.index_to_world, last);
  scale_column(header.index_to_world, axis, -1);
  return volume_of(flipped, std::move(header));
}

Volume permute_axes(const Volume& volume, const std::array<int, 3>& order) {
  const DenseGrid grid = dense_grid(volume);
  const std::size_t strides[3] = {1, static_cast<std::size_t>(grid.dims[0]),
                                  static_cast<std::size_t>(grid.dims[0]) * grid.dims[1]};
  DenseGrid permuted{{grid.dims[order[0]], grid.dims[order[1]], grid.dims[order[2]]},
                     std::vector<float>(grid.samples.size())};
  std::size_t next = 0;
  for (int k = 0; k < permuted.dims[2]; ++k) {
    for (int j = 0; j < permuted.dims[1]; ++j) {
      for (int i = 0; i < permuted.dims[0]; ++i) {
        permuted.samples[next++] = grid.samples[i * strides[order[0]] + j * strides[order[1]] + k * strides[order[2]]];
      }
    }
  }
  VolumeHeader header = volume.header();
  for (int axis = 0; axis < 3; ++axis) {
    for (int row = 0; row < 3; ++row) {
      header.index_to_world.rows[row][axis] = volume.header().index_to_world.rows[row][order[axis]];
    }
  }
  return volume_of(permuted, std::move(header));
}

}  // namespace delvox
