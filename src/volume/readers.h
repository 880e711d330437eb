#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "delvox/volume/read_volume.h"
#include "volume/byte_source.h"

namespace delvox {

/// One reader per format. Each takes the file opened at its start, where open_volume has recognised it, and throws
/// InputError or OptionError.
VolumeSourcePtr open_nifti(ByteSource source, const ReadVolumeOptions& options);
VolumeSourcePtr open_inrimage(ByteSource source, const ReadVolumeOptions& options);
VolumeSourcePtr open_raw_json(ByteSource source, const ReadVolumeOptions& options);
VolumeSourcePtr open_vdb(ByteSource source, const ReadVolumeOptions& options);

/// Slices in this order; `name` is what errors call the whole.
VolumeSourcePtr open_tiff_files(const std::filesystem::path& name, std::vector<std::filesystem::path> files,
                                const ReadVolumeOptions& options);
/// The TIFF files of a folder in natural order.
VolumeSourcePtr open_tiff_folder(const std::filesystem::path& folder, const ReadVolumeOptions& options);
/// The files that match a pattern of the shell, in natural order. Throws InputError if there is none.
std::vector<std::filesystem::path> files_matching(const std::filesystem::path& pattern);

/// Whether a file that begins with these bytes (at least 348 for NIfTI-1) is in the format.
bool looks_like_nifti(std::string_view start);
bool looks_like_inrimage(std::string_view start);
bool looks_like_tiff(std::string_view start);
bool looks_like_raw_json(std::string_view start);
bool looks_like_vdb(std::string_view start);

}  // namespace delvox
