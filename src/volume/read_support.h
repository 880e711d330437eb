#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "delvox/volume/read_volume.h"
#include "delvox/volume/volume_source.h"
#include "volume/sample_type.h"

namespace delvox {

class ByteSource;

/// Throws InputError "path: cause; mend", on one line whatever characters the parts contain.
[[noreturn]] void fail_input(const std::filesystem::path& path, const std::string& cause, const std::string& mend);

/// Number of samples of a volume of these dims, or InputError if a dim is not in 1..2^31-1 or the slices that are in
/// memory at a time would not fit into what is available.
std::size_t checked_voxel_count(const std::filesystem::path& path, const std::array<std::int64_t, 3>& dims);
/// Throws InputError if a volume with these dims would not fit into the memory available as a whole.
void check_fits_whole(const std::filesystem::path& path, const std::array<std::int64_t, 3>& dims);

/// What the samples of a file are and where they lie.
struct SampleLayout {
  SampleType type;
  bool big_endian = false;
  std::uint64_t offset = 0;  ///< of the first sample, from the start of the (inflated) data
  double slope = 1, intercept = 0;
};

/// Throws InputError unless the file can hold `count` samples.
void check_payload(const ByteSource& source, const SampleLayout& layout, std::size_t count);
/// Reads `count` samples as float32 from where the file stands. Throws InputError.
void read_sample_run(ByteSource& source, const SampleLayout& layout, std::size_t count, float* out,
                     ConversionTally& tally);
/// Throws InputError if a sample is not finite.
void check_finite(const std::filesystem::path& path, const ConversionTally& tally);
/// The warning if float32 does not hold all samples exactly.
std::vector<std::string> tally_warnings(const ConversionTally& tally, SampleType type);

/// Samples that follow each other in `payload`, i fastest. Checks that the file can hold them, and the header; errors
/// of the header name `path`. Throws InputError.
VolumeSourcePtr payload_source(const std::filesystem::path& path, VolumeHeader header,
                               const std::filesystem::path& payload, const SampleLayout& layout);
/// Throws InputError, with the file's name, for a header that no volume may have.
void check_volume_header(const std::filesystem::path& path, const VolumeHeader& header);

/// Throws OptionError if options.spacing is set, for formats that state their own.
void refuse_spacing(const std::filesystem::path& path, const ReadVolumeOptions& options);
/// Throws InputError unless options.volume_index is below `volumes`; adds a warning if there is more than one.
void check_volume_index(const std::filesystem::path& path, const ReadVolumeOptions& options, std::uint64_t volumes,
                        VolumeHeader& header);

/// A diagonal affine. Throws InputError unless spacing is positive and all is finite.
Affine3 axis_aligned(const std::filesystem::path& path, const Vector3& spacing, const Point3& origin);

}  // namespace delvox
