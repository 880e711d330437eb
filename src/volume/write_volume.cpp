#include "delvox/volume/write_volume.h"

#include <algorithm>
#include <string>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/writers.h"

namespace delvox {

void write_volume(const Volume& volume, const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".nii")) return write_nifti(volume, path, false);
  if (name.ends_with(".nii.gz")) return write_nifti(volume, path, true);
  if (name.ends_with(".tif") || name.ends_with(".tiff")) return write_tiff(volume, path);
  if (name.ends_with(".json")) return write_raw_json(volume, path);
  if (name.ends_with(".vdb")) return write_vdb(volume, path);
  throw OptionError(path.string() + ": not the name of a volume file; end it in .nii, .nii.gz, .tif, .json or .vdb");
}

}  // namespace delvox
