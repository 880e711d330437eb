#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "delvox/volume/read_volume.h"
#include "delvox/volume/volume.h"

namespace delvox {

class ByteSource;
enum class SampleType;
struct ConversionTally;

/// Throws InputError "path: cause; mend", on one line whatever characters the parts contain.
[[noreturn]] void fail_input(const std::filesystem::path& path, const std::string& cause, const std::string& mend);

/// Number of samples of a volume of these dims, or InputError if a dim is not in 1..2^31-1 or the volume would not
/// fit into this machine's memory.
std::size_t checked_voxel_count(const std::filesystem::path& path, const std::array<std::int64_t, 3>& dims);

/// What the samples of a file are and where they lie.
struct SampleLayout {
  SampleType type;
  bool big_endian = false;
  std::uint64_t offset = 0;  ///< of the first sample, from the start of the (inflated) data
  double slope = 1, intercept = 0;
};

/// Reads `count` samples as float32 from where layout says. Checks that the file can hold them, but after `out` was
/// allocated: callers with a size from a header use read_samples. Throws InputError.
void read_sample_run(ByteSource& source, const SampleLayout& layout, std::size_t count, float* out,
                     ConversionTally& tally);
/// Throws InputError if a sample is not finite; appends to header.warnings if float32 cannot hold them exactly.
void check_tally(const std::filesystem::path& path, const ConversionTally& tally, SampleType type,
                 VolumeHeader& header);
/// Throws InputError unless the file can hold `count` samples.
void check_payload(const ByteSource& source, const SampleLayout& layout, std::size_t count);

/// Reads `count` samples as float32, appending to header.warnings if float32 cannot hold them exactly.
/// Checks that the file can hold them before anything is allocated. Throws InputError, also for NaN and infinity.
std::vector<float> read_samples(ByteSource& source, const SampleLayout& layout, std::size_t count,
                                VolumeHeader& header);

/// The Volume, its errors prefixed with the file's name.
Volume make_volume(const std::filesystem::path& path, VolumeHeader header, const std::vector<float>& samples);

/// Throws OptionError if options.spacing is set, for formats that state their own.
void refuse_spacing(const std::filesystem::path& path, const ReadVolumeOptions& options);
/// Throws InputError unless options.volume_index is below `volumes`; adds a warning if there is more than one.
void check_volume_index(const std::filesystem::path& path, const ReadVolumeOptions& options, std::uint64_t volumes,
                        VolumeHeader& header);

/// A diagonal affine. Throws InputError unless spacing is positive and all is finite.
Affine3 axis_aligned(const std::filesystem::path& path, const Vector3& spacing, const Point3& origin);

}  // namespace delvox
