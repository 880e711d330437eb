#include "delvox/volume/preprocess.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "delvox/core/errors.h"
#include "volume/slice_filters.h"

namespace delvox {
namespace {

std::string format(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
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

VolumeSourcePtr crop(const VolumeSourcePtr& source, const IndexBox& box) {
  std::array<int, 3> begin, size;
  Point3 origin;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = std::max(box.begin[axis], 0);
    const int end = std::min(box.end[axis], source->dims()[axis]);
    if (begin[axis] >= end) {
      throw NothingToMesh("crop: nothing is left along axis " + std::string(1, "xyz"[axis]) +
                          ", which has voxels 0 to " + std::to_string(source->dims()[axis] - 1) +
                          "; choose a range inside");
    }
    size[axis] = end - begin[axis];
    origin[axis] = begin[axis];
  }
  VolumeHeader header = source->header();
  header.dims = size;
  move_origin(header.index_to_world, origin);
  return cropped(source, std::move(header), begin);
}

IndexBox index_box(const VolumeHeader& header, const Box3& world) {
  if (world.empty()) return {};
  const Affine3 world_to_index = header.index_to_world.inverse();
  Box3 indices;
  for (int corner = 0; corner < 8; ++corner) {
    indices.extend(world_to_index({corner & 1 ? world.max.x : world.min.x, corner & 2 ? world.max.y : world.min.y,
                                   corner & 4 ? world.max.z : world.min.z}));
  }
  constexpr double kRounding = 1e-6;  // voxel: a bound given at a voxel center includes it
  IndexBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double n = header.dims[axis];
    box.begin[axis] = static_cast<int>(std::clamp(std::ceil(indices.min[axis] - kRounding), 0.0, n));
    box.end[axis] = static_cast<int>(std::clamp(std::floor(indices.max[axis] + kRounding) + 1, 0.0, n));
  }
  return box;
}

VolumeSourcePtr smooth(const VolumeSourcePtr& source, const SmoothOptions& options) {
  const double sigma = options.sigma_mm;
  const Vector3 spacing = source->header().spacing();
  double extent = 0;
  std::array<double, 3> sigmas;
  for (int axis = 0; axis < 3; ++axis) {
    extent = std::max(extent, source->dims()[axis] * spacing[axis]);
    sigmas[axis] = sigma / spacing[axis];
  }
  if (!(sigma >= 0 && sigma <= extent)) {
    throw OptionError("smooth: sigma " + format(sigma) + " mm must be from 0 to the extent of the image, " +
                      format(extent) + " mm; try the voxel spacing");
  }
  return smoothed(source, sigmas);
}

VolumeSourcePtr resample(const VolumeSourcePtr& source, const ResampleOptions& options) {
  constexpr double kMaxVoxels = 2147483648.0;
  constexpr double kFullWidthPerSigma = 2.3548200450309493;  // 2 sqrt(2 ln 2)
  constexpr double kRounding = 1e-6;  // of a voxel: 64 voxels of 0.1 mm are 16 of 0.4, not 17
  const double spacing_mm = options.spacing_mm;
  if (!(spacing_mm > 0) || !std::isfinite(spacing_mm)) {
    throw OptionError("resample: spacing " + format(spacing_mm) + " mm must be positive; try the smallest voxel edge");
  }
  VolumeHeader header = source->header();
  const Vector3 spacing = header.spacing();
  std::array<double, 3> offset, step, sigmas;
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double n = source->dims()[axis], old = spacing[axis];
    const double wanted = std::max(1.0, std::ceil(n * old / spacing_mm - kRounding));
    voxels *= wanted;
    if (voxels > kMaxVoxels) {
      throw OptionError("resample: " + format(spacing_mm) +
                        " mm would make more than 2^31 voxels; choose a larger one");
    }
    header.dims[axis] = static_cast<int>(wanted);
    step[axis] = spacing_mm / old;
    // The middles of both fields of view coincide; indices name voxel centers.
    offset[axis] = 0.5 * (n - 1) - 0.5 * (wanted - 1) * step[axis];
    sigmas[axis] = spacing_mm > old ? std::sqrt(step[axis] * step[axis] - 1) / kFullWidthPerSigma : 0;
  }
  move_origin(header.index_to_world, {offset[0], offset[1], offset[2]});
  for (int axis = 0; axis < 3; ++axis) scale_column(header.index_to_world, axis, step[axis]);
  return interpolated(options.prefilter ? smoothed(source, sigmas) : source, std::move(header), offset, step);
}

Volume crop(const Volume& volume, const IndexBox& box) { return load(*crop(source_of(volume), box)); }
Volume smooth(const Volume& volume, const SmoothOptions& options) { return load(*smooth(source_of(volume), options)); }
Volume resample(const Volume& volume, const ResampleOptions& options) {
  return load(*resample(source_of(volume), options));
}

Volume flip_axis(const Volume& volume, int axis) {
  const std::vector<float> samples = volume.samples();
  std::vector<float> flipped(samples.size());
  const std::array<int, 3>& n = volume.dims();
  std::size_t next = 0;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        std::array<int, 3> from{i, j, k};
        from[axis] = n[axis] - 1 - from[axis];
        flipped[next++] = samples[(static_cast<std::size_t>(from[2]) * n[1] + from[1]) * n[0] + from[0]];
      }
    }
  }
  VolumeHeader header = volume.header();
  Point3 last{};
  last[axis] = n[axis] - 1;
  move_origin(header.index_to_world, last);
  scale_column(header.index_to_world, axis, -1);
  return Volume(std::move(header), flipped);
}

Volume permute_axes(const Volume& volume, const std::array<int, 3>& order) {
  const std::vector<float> samples = volume.samples();
  const std::array<int, 3>& n = volume.dims();
  const std::size_t strides[3] = {1, static_cast<std::size_t>(n[0]), static_cast<std::size_t>(n[0]) * n[1]};
  VolumeHeader header = volume.header();
  header.dims = {n[order[0]], n[order[1]], n[order[2]]};
  std::vector<float> permuted(samples.size());
  std::size_t next = 0;
  for (int k = 0; k < header.dims[2]; ++k) {
    for (int j = 0; j < header.dims[1]; ++j) {
      for (int i = 0; i < header.dims[0]; ++i) {
        permuted[next++] = samples[i * strides[order[0]] + j * strides[order[1]] + k * strides[order[2]]];
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int row = 0; row < 3; ++row) {
      header.index_to_world.rows[row][axis] = volume.header().index_to_world.rows[row][order[axis]];
    }
  }
  return Volume(std::move(header), permuted);
}

}  // namespace delvox
