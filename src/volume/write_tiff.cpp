// A multi-page float32 TIFF with ImageJ's description, which states spacing, origin and unit.
#include <tiffio.h>

#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/writers.h"

namespace delvox {
namespace {

namespace fs = std::filesystem;

void check_stateable(const VolumeSource& volume, const fs::path& path) {
  const Affine3& affine = volume.header().index_to_world;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double entry = affine.rows[row][column];
      if (row == column ? entry > 0 : std::abs(entry) <= 1e-9 * norm(affine.column(column))) continue;
      throw OptionError(path.string() +
                        ": TIFF cannot state an oblique or mirrored grid; write .nii, .json or .vdb instead");
    }
  }
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The keys of ImageJ, whose origin is the place in pixels where world coordinates are 0; xspacing, yspacing and frame
/// are ours: the resolution tags hold fractions only, and ImageJ has no word for a patient's frame.
std::string description(const VolumeHeader& header) {
  const Vector3 spacing = header.spacing();
  const std::string slices = std::to_string(header.dims[2]);
  std::string text = "ImageJ=1.11a\nimages=" + slices + "\nslices=" + slices + "\nunit=mm\nspacing=" +
                     number(spacing.z) + "\nloop=false\n";
  const char* keys[3] = {"xorigin", "yorigin", "zorigin"};
  for (int axis = 0; axis < 3; ++axis) {
    const double pixels = -header.index_to_world.rows[axis][3] / spacing[axis];
    if (pixels != 0) text += std::string(keys[axis]) + "=" + number(pixels) + "\n";
  }
  text += "xspacing=" + number(spacing.x) + "\nyspacing=" + number(spacing.y) + "\n";
  text += std::string("frame=") + to_string(header.frame) + "\n";
  return text;
}

int record_error(TIFF*, void* log, const char*, const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  *static_cast<std::string*>(log) = text;
  return 1;
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

struct TiffCloser {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffPtr = std::unique_ptr<TIFF, TiffCloser>;

TiffPtr open_tiff(const fs::path& path, bool big, std::string& error) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, record_error, &error);
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, nullptr);
  TiffPtr tiff(TIFFOpenExt(path.c_str(), big ? "w8" : "w", options));
  TIFFOpenOptionsFree(options);
  return tiff;
}

/// Samples as they are written: float32, or the whole numbers of 16 bits that they are.
bool write_page(TIFF* tiff, const VolumeHeader& header, const float* samples, bool uint16, bool first,
                const std::string& text) {
  const std::uint32_t width = static_cast<std::uint32_t>(header.dims[0]);
  const std::uint32_t height = static_cast<std::uint32_t>(header.dims[1]);
  const Vector3 spacing = header.spacing();
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, uint16 ? 16 : 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, uint16 ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height);
  // ImageJ counts pixels per unit of its description (mm) and leaves the tag's own unit open.
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1 / spacing.x);
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 1 / spacing.y);
  if (first) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, text.c_str());
  const std::size_t count = std::size_t{width} * height;
  std::vector<std::uint16_t> shorts;
  if (uint16) shorts.assign(samples, samples + count);
  const tmsize_t size = static_cast<tmsize_t>(count * (uint16 ? sizeof(std::uint16_t) : sizeof(float)));
  void* data = uint16 ? static_cast<void*>(shorts.data()) : const_cast<float*>(samples);
  return TIFFWriteEncodedStrip(tiff, 0, data, size) == size && TIFFWriteDirectory(tiff) == 1;
}

}  // namespace

void write_tiff(const VolumeSource& volume, const fs::path& path) {
  check_stateable(volume, path);
  // Classic TIFF counts bytes in 32 bits.
  constexpr std::size_t kClassicLimit = std::size_t{4000} << 20;
  const bool uint16 = volume.header().format == "phantom" && volume.header().sample_type == "uint16";
  const bool big = volume.voxel_count() * (uint16 ? sizeof(std::uint16_t) : sizeof(float)) > kClassicLimit;
  const std::string text = description(volume.header());
  OutputFile file(path);
  std::string error;
  TiffPtr tiff = open_tiff(file.temporary(), big, error);
  bool good = tiff != nullptr;
  const std::size_t slice = static_cast<std::size_t>(volume.dims()[0]) * volume.dims()[1];
  if (good) {
    for_each_slab(volume, [&](const float* samples, int first_k, int slices) {
      for (int n = 0; n < slices; ++n) {
        good = good && write_page(tiff.get(), volume.header(), samples + n * slice, uint16, first_k + n == 0, text);
      }
    });
  }
  good = good && TIFFFlush(tiff.get()) == 1;
  tiff.reset();
  if (!good || !error.empty()) {
    throw IoError(path.string() + ": cannot be written: " + error + "; free some space or choose another place");
  }
  file.commit_external();
}

}  // namespace delvox
