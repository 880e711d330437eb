#pragma once

#include <filesystem>

#include "delvox/volume/volume.h"

namespace delvox {

/// Writes a volume as float32 in the format that the extension names: .nii, .nii.gz, .tif/.tiff, .json (raw beside
/// it), .vdb. Throws IoError; OptionError for an unknown extension or a geometry that the format cannot state.
void write_volume(const Volume& volume, const std::filesystem::path& path);

}  // namespace delvox
