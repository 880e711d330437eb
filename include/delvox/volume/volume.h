#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Where a voxel grid lies in space and where it came from. All lengths in millimetres.
struct VolumeHeader {
  std::array<int, 3> dims{0, 0, 0};  ///< number of samples along i, j, k
  Affine3 index_to_world;            ///< maps (i, j, k), the centre of a voxel, to world; may be oblique
  Frame frame = Frame::kUnknown;     ///< what the file states of its world axes
  std::string format;                ///< "NIfTI-1", "TIFF", ...
  std::string sample_type;           ///< as stored in the file: "uint8", "float32", ...
  std::vector<std::string> warnings;  ///< what the reader found odd, one line each

  /// Edge lengths of a voxel along i, j, k.
  Vector3 spacing() const;
  /// Anatomical or plain axis letters of i, j, k, each the direction of growth: "RAS", "LPI", or "+x-y+z".
  std::string orientation() const;
};

/// A scalar field sampled on a regular grid, held in an OpenVDB FloatGrid (background 0, the header's affine as its
/// transform). Immutable; copies share the samples.
class Volume {
 public:
  /// `samples`: dims[0]*dims[1]*dims[2] floats, i fastest. Uniform regions collapse to tiles.
  /// Throws InputError: dims below 1, sample count not their product, a sample that is not finite,
  /// an affine that is singular or not finite.
  Volume(VolumeHeader header, const std::vector<float>& samples);

  const VolumeHeader& header() const;
  const std::array<int, 3>& dims() const { return header().dims; }
  std::size_t voxel_count() const;

  /// Sample (i, j, k); pre: inside dims. A tree search per call: for loops use copy_block.
  float value(int i, int j, int k) const;
  /// Copies the samples of [begin, begin + size) into out, i fastest. pre: the block lies inside dims.
  void copy_block(const std::array<int, 3>& begin, const std::array<int, 3>& size, float* out) const;
  /// All samples, i fastest.
  std::vector<float> samples() const;

  /// The range of the samples, those that load() has collapsed included.
  float min() const;
  float max() const;

  /// The grid behind it, for the rooms that may see OpenVDB (src/volume/volume_impl.h).
  struct Impl;
  explicit Volume(std::shared_ptr<const Impl> impl);
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace delvox
