#include "volume/tiff_file.h"

#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>
#include <optional>

#include "volume/read_support.h"

namespace delvox {

struct TiffFile::State {
  std::filesystem::path path;
  TIFF* tiff = nullptr;
  std::uint64_t file_size = 0;
  int page_number = 0;
  std::string last_error;
  std::vector<std::string> warnings;

  ~State() {
    if (tiff != nullptr) TIFFClose(tiff);
  }
  [[noreturn]] void fail(const std::string& cause, const std::string& mend = "copy or convert the file again") const {
    const std::string where = page_number > 0 ? "page " + std::to_string(page_number) + ": " : "";
    fail_input(path, where + cause, mend);
  }
  [[noreturn]] void fail_damaged() const {
    fail("damaged or truncated TIFF" + (last_error.empty() ? std::string() : " (libtiff: " + last_error + ")"));
  }
  template <class T>
  T field(std::uint32_t tag, T missing) const {
    T value = missing;
    return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : missing;
  }
  std::uint64_t capacity() const;
  void check_photometric(TiffPage& page);
  void set_sample_type(TiffPage& page);
  void check_size(const TiffPage& page) const;
  void convert_row(const TiffPage& page, const unsigned char* in, std::size_t count, float* out,
                   ConversionTally& tally) const;
  void read_strips(const TiffPage& page, float* out, ConversionTally& tally);
  void read_tiles(const TiffPage& page, float* out, ConversionTally& tally);
};

namespace {

std::string format_message(const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

int record_error(TIFF*, void* log, const char*, const char* format, va_list arguments) {
  *static_cast<std::string*>(log) = format_message(format, arguments);
  return 1;
}

int record_warning(TIFF*, void* log, const char*, const char* format, va_list arguments) {
  constexpr std::size_t kMostWarnings = 5;
  auto& warnings = *static_cast<std::vector<std::string>*>(log);
  const std::string text = "libtiff: " + format_message(format, arguments);
  // Private tags are in half of all files and harm nobody.
  const bool harmless = text.find("Unknown field") != std::string::npos;
  const bool known = std::find(warnings.begin(), warnings.end(), text) != warnings.end();
  if (!harmless && !known && warnings.size() < kMostWarnings) warnings.push_back(text);
  return 1;
}

/// How far a codec expands at most: deflate 1032, LZW's 12-bit codes 1365, PackBits 64; for the rest a generous bound.
std::uint64_t largest_expansion(int compression) {
  switch (compression) {
    case COMPRESSION_NONE: return 1;
    case COMPRESSION_PACKBITS: return 64;
    case COMPRESSION_LZW:
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_PIXARLOG: return 4096;
    default: return 65536;
  }
}

constexpr const char* kConvertToGrey = "convert it to one grey value per pixel first";

}  // namespace

std::string TiffPage::summary() const {
  const std::string sample = bits < 8 ? std::to_string(bits) + "-bit" : to_string(type);
  return std::to_string(width) + " x " + std::to_string(height) + " " + sample;
}

bool TiffPage::inverted() const {
  return min_is_white && type != SampleType::kFloat32 && type != SampleType::kFloat64;
}

double TiffPage::intercept() const {
  if (!inverted()) return 0;
  const bool is_signed = type == SampleType::kInt8 || type == SampleType::kInt16 || type == SampleType::kInt32 ||
                         type == SampleType::kInt64;
  return is_signed ? -1 : std::ldexp(1.0, bits) - 1;
}

TiffFile::TiffFile(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  state_->path = path;
  std::error_code error;
  state_->file_size = std::filesystem::file_size(path, error);
  if (error) fail_input(path, error.message(), "check the path");
  constexpr std::uint64_t kSmallestCap = std::uint64_t{64} << 20, kLargestCap = std::uint64_t{1} << 40;
  const std::uint64_t expanded = std::min(state_->file_size, kLargestCap / 4096) * 4096;
  const std::uint64_t cap = std::clamp(expanded, kSmallestCap, kLargestCap);
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(cap));
  TIFFOpenOptionsSetErrorHandlerExtR(options, record_error, &state_->last_error);
  TIFFOpenOptionsSetWarningHandlerExtR(options, record_warning, &state_->warnings);
  // 'm': no memory map, since a file that shrinks while it is read would kill the program.
  state_->tiff = TIFFOpenExt(path.c_str(), "rm", options);
  TIFFOpenOptionsFree(options);
  if (state_->tiff == nullptr) state_->fail_damaged();
}

TiffFile::~TiffFile() = default;

bool TiffFile::next_page() {
  if (TIFFLastDirectory(state_->tiff)) return false;
  ++state_->page_number;
  if (!TIFFReadDirectory(state_->tiff)) state_->fail_damaged();
  return true;
}

std::uint64_t TiffFile::State::capacity() const {
  const std::uint64_t expansion = largest_expansion(field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE));
  constexpr std::uint64_t kLimit = std::numeric_limits<std::uint64_t>::max();
  return file_size > kLimit / expansion ? kLimit : file_size * expansion;
}

void TiffFile::State::check_photometric(TiffPage& page) {
  const int samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  switch (photometric) {
    case PHOTOMETRIC_MINISWHITE: page.min_is_white = true; break;
    case PHOTOMETRIC_MINISBLACK:
    case PHOTOMETRIC_MASK: break;
    case PHOTOMETRIC_LOGL: TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT); break;
    case PHOTOMETRIC_RGB: fail("its pixels are RGB colours", kConvertToGrey);
    case PHOTOMETRIC_PALETTE: fail("its pixels are palette colours", kConvertToGrey);
    default: fail("its pixels are colours (photometric " + std::to_string(photometric) + ")", kConvertToGrey);
  }
  if (samples != 1) fail("it has " + std::to_string(samples) + " values per pixel (colour or alpha)", kConvertToGrey);
  if (field<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1) > 1) fail("it uses 3D pages (ImageDepth)", "save one page per slice");
}

void TiffFile::State::set_sample_type(TiffPage& page) {
  const int bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  const int format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  std::optional<SampleType> type;
  switch (format) {
    case SAMPLEFORMAT_UINT:
    case SAMPLEFORMAT_VOID: type = integer_type(bits, false); break;
    case SAMPLEFORMAT_INT: type = integer_type(bits, true); break;
    case SAMPLEFORMAT_IEEEFP: type = float_type(bits); break;
    default: fail("its samples are complex numbers", "convert it to magnitudes first");
  }
  page.bits = bits;
  if (!type && format != SAMPLEFORMAT_IEEEFP && (bits == 1 || bits == 2 || bits == 4)) type = SampleType::kUint8;
  if (!type) {
    fail("its samples have " + std::to_string(bits) + " bits, which is not supported",
         "convert it to 8, 16 or 32 bits first");
  }
  page.type = *type;
}

void TiffFile::State::check_size(const TiffPage& page) const {
  if (page.width == 0 || page.height == 0) fail("the image is " + page.summary());
  checked_voxel_count(path, {page.width, page.height, 1});
  const std::uint64_t row_bytes = (std::uint64_t{page.width} * page.bits + 7) / 8;
  const std::uint64_t block = TIFFIsTiled(tiff) ? TIFFTileSize64(tiff) : TIFFScanlineSize64(tiff);
  const std::uint64_t most = capacity();
  const bool fits = row_bytes * page.height <= most && block <= most;
  if (!fits) {
    fail("an image of " + page.summary() + " does not fit into the " + std::to_string(file_size) +
         " bytes of the file: truncated or damaged");
  }
  if (!TIFFIsTiled(tiff) && block != row_bytes) fail_damaged();
}

TiffPage TiffFile::page() const {
  TiffPage page;
  State& state = *state_;
  page.auxiliary = (state.field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
  if (page.auxiliary) return page;
  state.check_photometric(page);
  page.width = state.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  page.height = state.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  state.set_sample_type(page);
  state.check_size(page);
  const int compression = state.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  page.compressed = compression != COMPRESSION_NONE;
  if (!TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression))) {
    state.fail("compression " + std::to_string(compression) + " is unknown to this libtiff",
               "save it with deflate or without compression");
  }
  page.orientation = state.field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  page.resolution_unit = state.field<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  page.resolution_x = static_cast<double>(state.field<float>(TIFFTAG_XRESOLUTION, 0));
  page.resolution_y = static_cast<double>(state.field<float>(TIFFTAG_YRESOLUTION, 0));
  const char* description = nullptr;
  if (TIFFGetField(state.tiff, TIFFTAG_IMAGEDESCRIPTION, &description) == 1 && description != nullptr) {
    page.description = description;
  }
  return page;
}

void TiffFile::State::convert_row(const TiffPage& page, const unsigned char* in, std::size_t count, float* out,
                                  ConversionTally& tally) const {
  const double slope = page.slope(), intercept = page.intercept();
  if (page.bits >= 8) {
    constexpr bool kNativeBig = std::endian::native == std::endian::big;
    convert_samples(in, count, page.type, kNativeBig, slope, intercept, out, tally);
    return;
  }
  const unsigned mask = (1u << page.bits) - 1;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t bit = n * page.bits;
    const unsigned value = (in[bit / 8] >> (8 - page.bits - bit % 8)) & mask;
    out[n] = static_cast<float>(slope * value + intercept);
  }
}

void TiffFile::State::read_strips(const TiffPage& page, float* out, ConversionTally& tally) {
  const std::uint32_t rows_per_strip = std::min(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, page.height), page.height);
  if (rows_per_strip == 0) fail_damaged();
  const std::size_t row_bytes = static_cast<std::size_t>(TIFFScanlineSize64(tiff));
  std::vector<unsigned char> strip(row_bytes * rows_per_strip);
  std::uint32_t number = 0;
  for (std::uint32_t row = 0; row < page.height; row += std::min(rows_per_strip, page.height - row), ++number) {
    const std::uint32_t rows = std::min(rows_per_strip, page.height - row);
    const tmsize_t expected = static_cast<tmsize_t>(row_bytes * rows);
    if (TIFFReadEncodedStrip(tiff, number, strip.data(), expected) != expected) fail_damaged();
    for (std::uint32_t r = 0; r < rows; ++r) {
      convert_row(page, strip.data() + r * row_bytes, page.width, out + std::size_t{row + r} * page.width, tally);
    }
  }
}

void TiffFile::State::read_tiles(const TiffPage& page, float* out, ConversionTally& tally) {
  const std::uint32_t tile_width = field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
  const std::uint32_t tile_height = field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
  const std::size_t row_bytes = static_cast<std::size_t>(TIFFTileRowSize64(tiff));
  const std::size_t tile_bytes = static_cast<std::size_t>(TIFFTileSize64(tiff));
  // The format demands multiples of 16; odd widths of packed bits would not start on a byte.
  if (tile_width == 0 || tile_height == 0 || row_bytes != (std::uint64_t{tile_width} * page.bits + 7) / 8 ||
      tile_bytes != row_bytes * tile_height) {
    fail_damaged();
  }
  std::vector<unsigned char> tile(tile_bytes);
  for (std::uint64_t y = 0; y < page.height; y += tile_height) {
    for (std::uint64_t x = 0; x < page.width; x += tile_width) {
      const std::uint32_t number =
          TIFFComputeTile(tiff, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
      const tmsize_t expected = static_cast<tmsize_t>(tile_bytes);
      if (TIFFReadEncodedTile(tiff, number, tile.data(), expected) != expected) fail_damaged();
      const std::uint64_t rows = std::min<std::uint64_t>(tile_height, page.height - y);
      const std::uint64_t columns = std::min<std::uint64_t>(tile_width, page.width - x);
      for (std::uint64_t r = 0; r < rows; ++r) {
        convert_row(page, tile.data() + r * row_bytes, columns, out + (y + r) * page.width + x, tally);
      }
    }
  }
}

void TiffFile::read_page(const TiffPage& page, float* out, ConversionTally& tally) {
  if (TIFFIsTiled(state_->tiff)) {
    state_->read_tiles(page, out, tally);
  } else {
    state_->read_strips(page, out, tally);
  }
}

std::uint64_t TiffFile::first_sample_offset() const { return TIFFGetStrileOffset(state_->tiff, 0); }
bool TiffFile::big_endian() const { return TIFFIsBigEndian(state_->tiff) != 0; }

std::uint64_t TiffFile::capacity() const { return state_->capacity(); }

const std::vector<std::string>& TiffFile::warnings() const { return state_->warnings; }

}  // namespace delvox
