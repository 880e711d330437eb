// The NIfTI-1 and NIfTI-2 headers, field by field: see nifti1.h and nifti2.h of https://nifti.nimh.nih.gov.
#include "volume/nifti_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "volume/read_support.h"

namespace delvox {
namespace {

class FieldReader {
 public:
  FieldReader(std::string_view bytes, bool big_endian) : bytes_(bytes), swap_(big_endian != kNativeBig) {}
  template <class T>
  T get(std::size_t offset) const {
    unsigned char raw[sizeof(T)];
    for (std::size_t b = 0; b < sizeof(T); ++b) {
      raw[b] = static_cast<unsigned char>(bytes_[offset + (swap_ ? sizeof(T) - 1 - b : b)]);
    }
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

 private:
  static constexpr bool kNativeBig = std::endian::native == std::endian::big;
  std::string_view bytes_;
  bool swap_;
};

/// Where the real numbers lie.
struct FieldOffsets {
  std::size_t pixdim, slope, intercept, quatern, qoffset, srow;
};
constexpr FieldOffsets kOffsets1{76, 112, 116, 256, 268, 280};
constexpr FieldOffsets kOffsets2{104, 176, 184, 352, 376, 400};

template <class Real>
void read_reals(const FieldReader& field, const FieldOffsets& at, NiftiHeader& header) {
  const auto real = [&](std::size_t start, int n) {
    return static_cast<double>(field.get<Real>(start + n * sizeof(Real)));
  };
  for (int n = 0; n < 8; ++n) header.pixdim[n] = real(at.pixdim, n);
  header.slope = real(at.slope, 0);
  header.intercept = real(at.intercept, 0);
  for (int n = 0; n < 3; ++n) header.quatern[n] = real(at.quatern, n);
  for (int n = 0; n < 3; ++n) header.qoffset[n] = real(at.qoffset, n);
  for (int n = 0; n < 12; ++n) header.sform.rows[n / 4][n % 4] = real(at.srow, n);
}

void read_nifti1(const FieldReader& field, NiftiHeader& header) {
  for (int n = 0; n < 8; ++n) header.dim[n] = field.get<std::int16_t>(40 + 2 * n);
  header.datatype = field.get<std::int16_t>(70);
  header.bitpix = field.get<std::int16_t>(72);
  header.vox_offset = field.get<float>(108);
  header.xyzt_units = field.get<std::uint8_t>(123);
  header.qform_code = field.get<std::int16_t>(252);
  header.sform_code = field.get<std::int16_t>(254);
  read_reals<float>(field, kOffsets1, header);
}

void read_nifti2(const FieldReader& field, NiftiHeader& header) {
  for (int n = 0; n < 8; ++n) header.dim[n] = field.get<std::int64_t>(16 + 8 * n);
  header.datatype = field.get<std::int16_t>(12);
  header.bitpix = field.get<std::int16_t>(14);
  header.vox_offset = static_cast<double>(field.get<std::int64_t>(168));
  header.qform_code = field.get<std::int32_t>(344);
  header.sform_code = field.get<std::int32_t>(348);
  header.xyzt_units = field.get<std::int32_t>(500);
  read_reals<double>(field, kOffsets2, header);
}

bool has_size(std::string_view bytes, std::int32_t size, bool big_endian) {
  return bytes.size() >= 4 && FieldReader(bytes, big_endian).get<std::int32_t>(0) == size;
}

/// Method 2 of the standard: rotation by the quaternion, spacing by pixdim, the third axis mirrored if qfac is -1.
Affine3 qform_affine(const NiftiHeader& header) {
  double b = header.quatern[0], c = header.quatern[1], d = header.quatern[2];
  double a = 1 - (b * b + c * c + d * d);
  if (a < 1e-7) {  // rounding of a half turn
    const double scale = 1 / std::sqrt(b * b + c * c + d * d);
    b *= scale;
    c *= scale;
    d *= scale;
    a = 0;
  } else {
    a = std::sqrt(a);
  }
  const double qfac = header.pixdim[0] < 0 ? -1 : 1;
  const double step[3] = {std::abs(header.pixdim[1]), std::abs(header.pixdim[2]), qfac * std::abs(header.pixdim[3])};
  Affine3 result;
  result.rows = {{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c), header.qoffset[0]},
                  {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b), header.qoffset[1]},
                  {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - c * c - b * b, header.qoffset[2]}}};
  for (auto& row : result.rows) {
    for (int axis = 0; axis < 3; ++axis) row[axis] *= step[axis];
  }
  return result;
}

double unit_in_mm(const NiftiHeader& header, std::vector<std::string>& warnings) {
  switch (header.xyzt_units & 7) {
    case 1: return 1000;
    case 2: return 1;
    case 3: return 0.001;
    case 0: warnings.push_back("the header states no unit of length; millimetres assumed"); return 1;
    default: warnings.push_back("the header's unit of length is unknown; millimetres assumed"); return 1;
  }
}

/// Largest distance between the images of a voxel under two affines, over the grid's corners.
double largest_difference(const Affine3& one, const Affine3& other, const std::array<int, 3>& dims) {
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point3 p{corner & 1 ? dims[0] - 1.0 : 0, corner & 2 ? dims[1] - 1.0 : 0, corner & 4 ? dims[2] - 1.0 : 0};
    largest = std::max(largest, distance(one(p), other(p)));
  }
  return largest;
}

void check_pixdim(const std::filesystem::path& path, const NiftiHeader& header, bool used,
                  std::vector<std::string>& warnings) {
  for (int axis = 1; axis <= 3; ++axis) {
    const double spacing = header.pixdim[axis];
    const std::string name = "pixdim[" + std::to_string(axis) + "]";
    if (!std::isfinite(spacing)) fail_input(path, name + " is not finite", "correct the voxel spacing in the header");
    if (!used) continue;
    if (spacing == 0) fail_input(path, name + " is 0", "correct the voxel spacing in the header");
    if (spacing < 0) warnings.push_back(name + " is negative; its absolute value was taken");
  }
}

}  // namespace

int nifti_version(std::string_view bytes) {
  using namespace std::string_view_literals;
  for (bool big_endian : {false, true}) {
    if (has_size(bytes, kNifti1HeaderSize, big_endian) && bytes.size() >= kNifti1HeaderSize) {
      const std::string_view magic = bytes.substr(344, 4);
      if (magic == "n+1\0"sv || magic == "ni1\0"sv) return 1;
    }
    if (has_size(bytes, kNifti2HeaderSize, big_endian) && bytes.size() >= 12) {
      const std::string_view magic = bytes.substr(4, 8);
      if (magic == "n+2\0\r\n\x1a\n"sv || magic == "ni2\0\r\n\x1a\n"sv) return 2;
    }
  }
  return 0;
}

NiftiHeader parse_nifti_header(std::string_view bytes) {
  NiftiHeader header;
  header.version = nifti_version(bytes);
  const bool first = header.version == 1;
  header.big_endian = has_size(bytes, first ? kNifti1HeaderSize : kNifti2HeaderSize, true);
  header.pair = bytes[first ? 345 : 5] == 'i';
  const FieldReader field(bytes, header.big_endian);
  if (first) {
    read_nifti1(field, header);
  } else {
    read_nifti2(field, header);
  }
  return header;
}

Affine3 nifti_affine(const std::filesystem::path& path, const NiftiHeader& header, const std::array<int, 3>& dims,
                     std::vector<std::string>& warnings) {
  const bool has_sform = header.sform_code > 0, has_qform = header.qform_code > 0;
  check_pixdim(path, header, !has_sform, warnings);
  Affine3 affine = has_sform ? header.sform : qform_affine(header);
  if (!has_sform && !has_qform) {
    const Vector3 spacing{std::abs(header.pixdim[1]), std::abs(header.pixdim[2]), std::abs(header.pixdim[3])};
    affine = axis_aligned(path, spacing, {});
    warnings.push_back("neither sform nor qform is set: position and orientation are unknown, left may be right");
  }
  const Vector3 columns{norm(affine.column(0)), norm(affine.column(1)), norm(affine.column(2))};
  const double smallest = std::min({columns.x, columns.y, columns.z});
  if (has_sform && has_qform && largest_difference(affine, qform_affine(header), dims) > 0.1 * smallest) {
    warnings.push_back("sform and qform disagree; sform was taken");
  }
  if (has_sform && !has_qform) {
    for (int axis = 0; axis < 3; ++axis) {
      const double stated = std::abs(header.pixdim[axis + 1]);
      if (std::abs(columns[axis] - stated) <= 0.01 * columns[axis] || dims[axis] == 1) continue;
      warnings.push_back("sform and pixdim disagree on the spacing; sform was taken");
      break;
    }
  }
  const double unit = unit_in_mm(header, warnings);
  for (auto& row : affine.rows) {
    for (double& entry : row) entry *= unit;
  }
  return affine;
}

}  // namespace delvox
