#include "delvox/volume/read_volume.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>
#include <system_error>

#include "delvox/core/errors.h"
#include "volume/byte_source.h"
#include "volume/read_support.h"
#include "volume/readers.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBytesToRecognise = 1024;

/// The extension in small letters, ".gz" included: ".nii.gz".
std::string full_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  if (extension == ".gz") extension = path.stem().extension().string() + extension;
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// The header x.hdr or x.hdr.gz that belongs to a file x.img or x.img.gz; empty if there is none.
fs::path header_of_pair(const fs::path& image_path) {
  fs::path stem = image_path;
  if (stem.extension() == ".gz") stem.replace_extension();
  for (const char* extension : {".hdr", ".hdr.gz"}) {
    fs::path candidate = stem;
    candidate.replace_extension(extension);
    std::error_code error;
    if (fs::exists(candidate, error)) return candidate;
  }
  return {};
}

[[noreturn]] void fail_unrecognised(const fs::path& path, const std::string& start) {
  const std::string extension = full_extension(path);
  const auto has = [&](std::string_view magic, std::size_t offset) {
    return start.size() >= offset + magic.size() && start.compare(offset, magic.size(), magic) == 0;
  };
  const std::string convert = "convert it to NIfTI first";
  if (has("DICM", 128)) fail_input(path, "it is DICOM, which is not read", convert + ", e.g. with dcm2niix");
  if (looks_like_tiff(start) || looks_like_vdb(start)) {
    fail_input(path, "gzip around a format that compresses by itself", "gunzip it first");
  }
  if (has("NRRD", 0)) fail_input(path, "it is NRRD, which is not read", convert);
  if (has("ObjectType", 0) || has("NDims", 0)) fail_input(path, "it is MetaImage, which is not read", convert);
  if (extension == ".nii" || extension == ".nii.gz" || extension == ".hdr" || extension == ".hdr.gz") {
    fail_input(path, start.size() < 348 ? "truncated: too short for a NIfTI header"
                                        : "wrong magic: the content is not NIfTI (an Analyze file?)",
               "copy the file again or convert it");
  }
  if (extension == ".inr" || extension == ".inr.gz") {
    fail_input(path, "wrong magic: the content is not Inrimage-4", "copy the file again or convert it");
  }
  if (extension == ".tif" || extension == ".tiff" || extension == ".vdb" || extension == ".json") {
    fail_input(path, "wrong magic: the content is not " + extension.substr(1), "copy the file again or convert it");
  }
  if (extension == ".img" || extension == ".img.gz") {
    fail_input(path, "its header is missing: no .hdr beside it", "keep .hdr and .img together");
  }
  fail_input(path, "not a volume format that is known",
             "give NIfTI, Inrimage, TIFF, OpenVDB or raw samples with a JSON sidecar");
}

[[noreturn]] void fail_for_memory(const fs::path& path) {
  fail_input(path, "there is not enough memory for it", "crop or resample the file first");
}

VolumeSourcePtr open_recognised(const fs::path& path, const ReadVolumeOptions& options) {
  std::error_code error;
  if (fs::is_directory(path, error)) return open_tiff_folder(path, options);
  if (!fs::exists(path, error) && path.native().find_first_of("*?[") != std::string::npos) {
    std::vector<fs::path> files = files_matching(path);
    if (files.size() == 1) return open_recognised(files[0], options);
    return open_tiff_files(path, std::move(files), options);
  }
  ByteSource source(path);
  const std::string start = source.peek(kBytesToRecognise);
  if (looks_like_nifti(start)) return open_nifti(std::move(source), options);
  if (looks_like_inrimage(start)) return open_inrimage(std::move(source), options);
  if (looks_like_vdb(start) && !source.compressed()) return open_vdb(std::move(source), options);
  if (looks_like_tiff(start) && !source.compressed()) return open_tiff_files(path, {path}, options);
  if (looks_like_raw_json(start)) return open_raw_json(std::move(source), options);
  const std::string extension = full_extension(path);
  if (extension == ".img" || extension == ".img.gz") {
    const fs::path header = header_of_pair(path);
    if (!header.empty()) return open_recognised(header, options);
  }
  fail_unrecognised(path, start);
}

}  // namespace

VolumeSourcePtr open_volume(const fs::path& path, const ReadVolumeOptions& options) {
  if (options.spacing) {
    for (int axis = 0; axis < 3; ++axis) {
      const double spacing = (*options.spacing)[axis];
      if (!(spacing > 0) || !std::isfinite(spacing)) throw OptionError("--spacing: give positive lengths in mm");
    }
  }
  try {
    return open_recognised(path, options);
  } catch (const std::bad_alloc&) {
    fail_for_memory(path);
  }
}

Volume read_volume(const fs::path& path, const ReadVolumeOptions& options) {
  const VolumeSourcePtr source = open_volume(path, options);
  const std::array<int, 3>& n = source->dims();
  check_fits_whole(path, {n[0], n[1], n[2]});
  try {
    return load(*source);
  } catch (const std::bad_alloc&) {
    fail_for_memory(path);
  }
}

}  // namespace delvox
