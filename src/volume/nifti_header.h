#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// The fields of a NIfTI-1 or NIfTI-2 header that concern us, as stored.
struct NiftiHeader {
  int version = 1;
  bool big_endian = false;
  bool pair = false;  ///< header and samples in two files
  std::array<std::int64_t, 8> dim{};
  int datatype = 0, bitpix = 0;
  std::array<double, 8> pixdim{};
  double vox_offset = 0;
  double slope = 1, intercept = 0;
  int xyzt_units = 0;
  int qform_code = 0, sform_code = 0;
  std::array<double, 3> quatern{}, qoffset{};
  Affine3 sform;
};

constexpr std::size_t kNifti1HeaderSize = 348, kNifti2HeaderSize = 540;

/// Decodes a header; pre: looks_like_nifti(bytes) and the whole header is there.
NiftiHeader parse_nifti_header(std::string_view bytes);
/// 1 or 2, or 0 if these bytes are not the start of a NIfTI header.
int nifti_version(std::string_view bytes);

/// The affine in millimetres of an image of these dims, and what is odd about it. Throws InputError.
Affine3 nifti_affine(const std::filesystem::path& path, const NiftiHeader& header, const std::array<int, 3>& dims,
                     std::vector<std::string>& warnings);

}  // namespace delvox
