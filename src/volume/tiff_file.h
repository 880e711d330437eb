#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "volume/sample_type.h"

namespace delvox {

/// What a page (directory) of a TIFF file says of itself, as far as it concerns volumes.
struct TiffPage {
  std::uint32_t width = 0, height = 0;
  int bits = 8;  ///< per sample: 1, 2, 4 (unsigned), or the size of `type`
  SampleType type = SampleType::kUint8;
  bool min_is_white = false;
  bool compressed = false;
  bool auxiliary = false;  ///< a thumbnail or a mask of another page: nothing else is filled in
  int orientation = 1;
  std::string description;
  double resolution_x = 0, resolution_y = 0;  ///< pixels per unit; 0 where not stated
  int resolution_unit = 2;                    ///< 1 none, 2 inch, 3 cm

  /// Whether stored values are to be complemented: integers of MinIsWhite. Floats have no white, ImageJ's neither.
  bool inverted() const;
  /// value = slope * stored + intercept: for inverted ones largest - stored, of signed integers -1 - stored.
  double slope() const { return inverted() ? -1 : 1; }
  double intercept() const;
  std::uint64_t pixel_count() const { return std::uint64_t{width} * height; }
  /// "640 x 480 uint16"
  std::string summary() const;
};

/// A TIFF file opened by libtiff at its first page. libtiff's messages go into ours, never to stderr. Every error is
/// an InputError that names the file.
class TiffFile {
 public:
  explicit TiffFile(const std::filesystem::path& path);
  ~TiffFile();
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  /// Goes to the next page; false at the end of the file. Throws if there is one but it cannot be read.
  bool next_page();
  /// The current page. Throws for colour, complex samples and the like, and for pages larger than the file can hold.
  TiffPage page() const;
  /// Decodes the current page into page().pixel_count() floats; every strip or tile must be there in full.
  void read_page(const TiffPage& page, float* out, ConversionTally& tally);
  /// Where the samples of the current page begin; for files whose further slices follow without pages of their own.
  std::uint64_t first_sample_offset() const;
  bool big_endian() const;
  /// How many bytes of samples the file may hold at most, given the compression of the current page.
  std::uint64_t capacity() const;
  const std::vector<std::string>& warnings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What ImageJ and the resolution tags tell of the geometry of a stack.
struct TiffGeometry {
  std::array<double, 3> spacing{0, 0, 0};  ///< mm; 0 where not stated
  std::array<double, 3> origin{0, 0, 0};   ///< mm, of the first voxel's centre
  bool from_imagej = false;
  int images = 1, channels = 1, slices = 1, frames = 1;
  double slope = 1, intercept = 0;  ///< ImageJ's linear calibration
  std::string frame;                ///< "RAS" or "LPS" as write_volume notes it
};
TiffGeometry parse_tiff_geometry(const TiffPage& page, std::vector<std::string>& warnings);

}  // namespace delvox
