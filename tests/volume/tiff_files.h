#pragma once

#include <tiffio.h>

#include <string>
#include <vector>

#include "volume/volume_files.h"

namespace delvox::testing {

/// A TIFF to be written for a test; every page is `width` x `height` and counts on from the one before.
struct TiffSpec {
  std::uint32_t width = 5, height = 4, pages = 3;
  int bits = 8, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK, samples_per_pixel = 1;
  int compression = COMPRESSION_NONE, planar = PLANARCONFIG_CONTIG, predictor = 0;
  std::uint32_t tile = 0;            // edge of tiles; 0 writes strips
  std::uint32_t rows_per_strip = 3;  // uneven on purpose
  double resolution_x = 0, resolution_y = 0;
  int resolution_unit = 0;
  std::string description;
  std::string mode = "w";  // "w8": BigTIFF; 'b', 'l': byte order
  int first_value = 0;
};

/// The bytes of sample number n, in native order.
inline std::string tiff_sample(const TiffSpec& spec, int n) {
  const bool is_float = spec.format == SAMPLEFORMAT_IEEEFP;
  if (is_float) return spec.bits == 32 ? bytes_of(static_cast<float>(n)) : bytes_of(static_cast<double>(n));
  switch (spec.bits) {
    case 8: return bytes_of(static_cast<std::uint8_t>(n));
    case 16: return bytes_of(static_cast<std::uint16_t>(n));
    case 32: return bytes_of(static_cast<std::uint32_t>(n));
    default: return bytes_of(static_cast<std::uint64_t>(n));
  }
}

/// A block of pixels from (x, y), zero beyond the image.
inline std::string tiff_block(const TiffSpec& spec, int page, std::uint32_t x, std::uint32_t y, std::uint32_t w,
                              std::uint32_t h) {
  const int start = spec.first_value + page * static_cast<int>(spec.width * spec.height);
  std::string block;
  for (std::uint32_t r = y; r < y + h; ++r) {
    std::string row;
    for (std::uint32_t c = x; c < x + w; ++c) {
      const bool inside = r < spec.height && c < spec.width;
      const int n = inside ? start + static_cast<int>(r * spec.width + c) : 0;
      if (spec.bits >= 8) {
        for (int s = 0; s < spec.samples_per_pixel; ++s) row += tiff_sample(spec, n);
        continue;
      }
      const std::uint32_t bit = (c - x) * spec.bits;
      if (bit % 8 == 0) row += '\0';
      row.back() = static_cast<char>(row.back() | (n & ((1 << spec.bits) - 1)) << (8 - spec.bits - bit % 8));
    }
    block += row;
  }
  return block;
}

inline void write_tiff_page(TIFF* tiff, const TiffSpec& spec, int page) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, spec.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, spec.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, spec.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, spec.samples_per_pixel);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, spec.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, spec.photometric);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, spec.planar);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, spec.compression);
  if (spec.predictor != 0) TIFFSetField(tiff, TIFFTAG_PREDICTOR, spec.predictor);
  if (spec.photometric == PHOTOMETRIC_PALETTE) {
    std::vector<std::uint16_t> map(256);
    TIFFSetField(tiff, TIFFTAG_COLORMAP, map.data(), map.data(), map.data());
  }
  if (spec.resolution_x > 0) TIFFSetField(tiff, TIFFTAG_XRESOLUTION, spec.resolution_x);
  if (spec.resolution_y > 0) TIFFSetField(tiff, TIFFTAG_YRESOLUTION, spec.resolution_y);
  if (spec.resolution_unit > 0) TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, spec.resolution_unit);
  if (page == 0 && !spec.description.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, spec.description.c_str());
  if (spec.tile > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, spec.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, spec.tile);
    for (std::uint32_t y = 0; y < spec.height; y += spec.tile) {
      for (std::uint32_t x = 0; x < spec.width; x += spec.tile) {
        std::string block = tiff_block(spec, page, x, y, spec.tile, spec.tile);
        const std::uint32_t number = TIFFComputeTile(tiff, x, y, 0, 0);
        TIFFWriteEncodedTile(tiff, number, block.data(), static_cast<tmsize_t>(block.size()));
      }
    }
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, spec.rows_per_strip);
    for (std::uint32_t y = 0, strip = 0; y < spec.height; y += spec.rows_per_strip, ++strip) {
      std::string block = tiff_block(spec, page, 0, y, spec.width, std::min(spec.rows_per_strip, spec.height - y));
      TIFFWriteEncodedStrip(tiff, strip, block.data(), static_cast<tmsize_t>(block.size()));
    }
  }
  TIFFWriteDirectory(tiff);
}

inline fs::path write_tiff_file(const fs::path& path, const TiffSpec& spec) {
  TIFF* tiff = TIFFOpen(path.c_str(), spec.mode.c_str());
  for (std::uint32_t page = 0; page < spec.pages; ++page) write_tiff_page(tiff, spec, static_cast<int>(page));
  TIFFClose(tiff);
  return path;
}

}  // namespace delvox::testing
