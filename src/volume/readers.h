#pragma once

#include <filesystem>
#include <string_view>

#include "delvox/volume/read_volume.h"
#include "volume/byte_source.h"

namespace delvox {

/// One reader per format. Each takes the file opened at its start, where read_volume has recognised it, and throws
/// InputError or OptionError.
Volume read_nifti(ByteSource source, const ReadVolumeOptions& options);
Volume read_inrimage(ByteSource source, const ReadVolumeOptions& options);

/// Whether a file that begins with these bytes (at least 348 for NIfTI-1) is in the format.
bool looks_like_nifti(std::string_view start);
bool looks_like_inrimage(std::string_view start);

}  // namespace delvox
