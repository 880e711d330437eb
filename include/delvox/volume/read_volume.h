#pragma once

#include <filesystem>
#include <optional>

#include "delvox/volume/volume_source.h"

namespace delvox {

/// What the file does not tell.
struct ReadVolumeOptions {
  std::optional<Vector3> spacing;  ///< mm; replaces what a TIFF says or lacks; an error on formats that state theirs
  int volume_index = 0;            ///< which volume of a 4D file
};

/// Opens a volume, of which only what stands beside the samples is read; the format is recognised by content first,
/// then by extension: NIfTI-1 and -2 (.nii, .nii.gz, .hdr/.img), Inrimage (.inr, .inr.gz), TIFF (a file, a folder or a
/// glob of slices in natural order), raw with a JSON sidecar (.json), OpenVDB (.vdb, which is read as a whole). Affine
/// in millimetres, in the frame that the file states.
/// Throws InputError, one line: file, cause, mend. Never allocates more than the file can hold.
VolumeSourcePtr open_volume(const std::filesystem::path& path, const ReadVolumeOptions& options = {});

/// Opens a volume and reads all of it into memory. Throws as open_volume does.
Volume read_volume(const std::filesystem::path& path, const ReadVolumeOptions& options = {});

}  // namespace delvox
