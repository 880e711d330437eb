#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "delvox/volume/level_set.h"
#include "delvox/volume/ties.h"
#include "delvox/volume/volume.h"

namespace delvox {

/// One pass through the slices of a volume, k ascending.
class SliceReader {
 public:
  virtual ~SliceReader() = default;
  /// The next `count` slices, i fastest. pre: there are that many. Throws InputError.
  virtual void read(int count, float* out) = 0;
  /// What was odd in the samples so far, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }
};

/// A volume that can be read slice by slice, as often as needed, without being whole in memory.
class VolumeSource {
 public:
  explicit VolumeSource(VolumeHeader header) : header_(std::move(header)) {}
  virtual ~VolumeSource() = default;
  VolumeSource(const VolumeSource&) = delete;
  VolumeSource& operator=(const VolumeSource&) = delete;

  /// Without what only the samples tell.
  const VolumeHeader& header() const { return header_; }
  const std::array<int, 3>& dims() const { return header_.dims; }
  std::size_t voxel_count() const {
    return static_cast<std::size_t>(dims()[0]) * static_cast<std::size_t>(dims()[1]) *
           static_cast<std::size_t>(dims()[2]);
  }
  /// Begins a pass at slice 0. Passes are independent of each other; none may outlive the source.
  virtual std::unique_ptr<SliceReader> start() const = 0;
  /// All samples, for sources that hold them; else null.
  virtual const float* samples() const { return nullptr; }

 private:
  VolumeHeader header_;
};
/// Sources are immutable and shared.
using VolumeSourcePtr = std::shared_ptr<const VolumeSource>;

/// The volume as a source; shares its samples.
VolumeSourcePtr source_of(const Volume& volume);
/// A source that holds all samples. pre: as many as the dims say.
VolumeSourcePtr source_of(VolumeHeader header, std::vector<float> samples);
/// Reads all of a source, so that further passes cost nothing.
VolumeSourcePtr in_memory(const VolumeSource& source);

/// Slices that are visited together, and what OpenVDB's leaves measure along each axis.
inline constexpr int kSlabSlices = 8;
/// Calls visit(samples, k, slices) for slabs of kSlabSlices slices (the last may have fewer) from k = 0 on, while the
/// next slab is being read. A slab stays in place until the visit of the next has returned. Returns the warnings.
std::vector<std::string> for_each_slab(const VolumeSource& source,
                                       const std::function<void(const float*, int, int)>& visit);

/// Reads a source into a volume. With a surface, memory follows the surface, not the volume: an 8x8x8 block of voxels
/// that no cell near the surface touches becomes one value on the same side of it, and all that is computed from this
/// one isosurface stays the same to the bit (regions, oracle). `ties`, if given, is shown all samples. Throws InputError.
Volume load(const VolumeSource& source, const std::optional<Isosurface>& surface = {}, Ties* ties = nullptr);

}  // namespace delvox
