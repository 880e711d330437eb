#include "delvox/volume/write_volume.h"

#include <algorithm>
#include <string>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/writers.h"

namespace delvox {

namespace {

std::string small_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

bool is_tiff(const std::string& name) { return name.ends_with(".tif") || name.ends_with(".tiff"); }

}  // namespace

void write_volume(const VolumeSource& source, const std::filesystem::path& path) {
  if (is_tiff(small_name(path))) return write_tiff(source, path);
  write_volume(load(source), path);
}

void write_volume(const Volume& volume, const std::filesystem::path& path) {
  const std::string name = small_name(path);
  if (name.ends_with(".nii")) return write_nifti(volume, path, false);
  if (name.ends_with(".nii.gz")) return write_nifti(volume, path, true);
  if (is_tiff(name)) return write_tiff(*source_of(volume), path);
  if (name.ends_with(".json")) return write_raw_json(volume, path);
  if (name.ends_with(".vdb")) return write_vdb(volume, path);
  throw OptionError(path.string() + ": not the name of a volume file; end it in .nii, .nii.gz, .tif, .json or .vdb");
}

}  // namespace delvox
