#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "volume/read_support.h"
#include "volume/tiff_file.h"

namespace delvox {

/// Where a page is; the pages of a file count from 1.
struct TiffPageRef {
  std::size_t file;
  int page;
};

/// The slices of a stack of TIFF pages, in order.
struct TiffSlices {
  std::filesystem::path name;  ///< what errors call the whole
  std::vector<std::filesystem::path> files;
  std::vector<TiffPageRef> pages;
  TiffPage first;
  bool contiguous = false;  ///< ImageJ's large stacks: one page, the other slices follow its samples
  SampleLayout layout{};    ///< of the first slice, if contiguous
  double slope = 1, intercept = 0;  ///< ImageJ's calibration, on top of the page's own

  /// Throws InputError unless a page has the size and type of the first.
  void compare(const TiffPage& page, std::size_t file, int number) const;
};

VolumeSourcePtr tiff_source(VolumeHeader header, TiffSlices slices);

}  // namespace delvox
