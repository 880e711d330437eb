#pragma once

#include <filesystem>

#include "delvox/volume/volume_source.h"

namespace delvox {

/// Writes a volume as float32 in the format that the extension names: .nii, .nii.gz, .tif/.tiff, .json (raw beside
/// it), .vdb. The same volume gives the same bytes.
///
/// What each keeps besides the samples: raw+JSON the affine and frame exactly, VDB to the last bits. NIfTI rounds the
/// affine to float32 (NIfTI-2, for axes beyond 32767, does not) and is always RAS: LPS is turned, an unknown frame is
/// written as it stands with sform code 2 ("aligned"). TIFF states spacing, origin and frame in an ImageJ description
/// and cannot state oblique or mirrored axes.
///
/// Throws IoError; OptionError for an unknown extension or a geometry that the format cannot state.
void write_volume(const Volume& volume, const std::filesystem::path& path);
/// The same from a source: TIFF slice by slice, other formats by way of memory. Of a phantom of type uint16 a TIFF
/// keeps the type.
void write_volume(const VolumeSource& source, const std::filesystem::path& path);

}  // namespace delvox
