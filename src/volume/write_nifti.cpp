// NIfTI-1, or NIfTI-2 where a dimension is beyond 32767; float32; sform always, qform where it can say the same.
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "volume/nifti_header.h"
#include "volume/writers.h"

namespace delvox {
namespace {

constexpr std::size_t kExtensionFlagSize = 4;
constexpr int kUnitMm = 2, kFloat32 = 16;
constexpr int kScanner = 1, kAligned = 2;

/// A rotation as NIfTI's quaternion, or none.
struct Qform {
  bool exists = false;
  double b = 0, c = 0, d = 0, qfac = 1;
};

/// Only an affine with orthogonal columns has one. After a mirrored third axis is turned round it is a rotation R;
/// the quaternion's largest component is taken from R's diagonal, the others from its off-diagonal sums.
Qform qform_of(const Affine3& affine) {
  Qform result;
  Vector3 x = affine.column(0), y = affine.column(1), z = affine.column(2);
  x = (1 / norm(x)) * x;
  y = (1 / norm(y)) * y;
  z = (1 / norm(z)) * z;
  constexpr double kOrthogonal = 1e-6;
  if (std::abs(dot(x, y)) > kOrthogonal || std::abs(dot(y, z)) > kOrthogonal || std::abs(dot(z, x)) > kOrthogonal) {
    return result;
  }
  result.exists = true;
  if (dot(cross(x, y), z) < 0) {
    result.qfac = -1;
    z = -1.0 * z;
  }
  const double trace = x.x + y.y + z.z;
  const double squares[4] = {1 + trace, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z};
  const int largest = static_cast<int>(std::max_element(squares, squares + 4) - squares);
  const double q = 0.5 * std::sqrt(squares[largest]);
  const double sums[4][4] = {{0, y.z - z.y, z.x - x.z, x.y - y.x},
                             {y.z - z.y, 0, y.x + x.y, z.x + x.z},
                             {z.x - x.z, y.x + x.y, 0, y.z + z.y},
                             {x.y - y.x, z.x + x.z, y.z + z.y, 0}};
  double quaternion[4];
  for (int n = 0; n < 4; ++n) quaternion[n] = n == largest ? q : sums[largest][n] / (4 * q);
  const double sign = quaternion[0] < 0 ? -1 : 1;  // NIfTI's first component, not stored, is positive
  result.b = sign * quaternion[1];
  result.c = sign * quaternion[2];
  result.d = sign * quaternion[3];
  return result;
}

/// NIfTI's world is RAS: LPS is turned about z. An unknown frame is written as it is, with code 2.
Affine3 to_ras(const VolumeHeader& header) {
  Affine3 affine = header.index_to_world;
  if (header.frame != Frame::kLps) return affine;
  for (int row = 0; row < 2; ++row) {
    for (double& entry : affine.rows[row]) entry = -entry;
  }
  return affine;
}

class HeaderWriter {
 public:
  explicit HeaderWriter(std::size_t size) : bytes_(size + kExtensionFlagSize, '\0') {}
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
  }
  void put_text(std::size_t offset, const char* text, std::size_t size) {
    std::memcpy(bytes_.data() + offset, text, size);
  }
  template <class Real>
  void put_geometry(const VolumeHeader& header, std::size_t pixdim, std::size_t quatern, std::size_t srow) {
    const Affine3 affine = to_ras(header);
    const Qform qform = qform_of(affine);
    const Vector3 spacing = header.spacing();
    const double pixdims[4] = {qform.qfac, spacing.x, spacing.y, spacing.z};
    for (int n = 0; n < 4; ++n) put(pixdim + n * sizeof(Real), static_cast<Real>(pixdims[n]));
    const double q[6] = {qform.b, qform.c, qform.d, affine.rows[0][3], affine.rows[1][3], affine.rows[2][3]};
    for (int n = 0; n < 6; ++n) put(quatern + n * sizeof(Real), static_cast<Real>(q[n]));
    for (int n = 0; n < 12; ++n) put(srow + n * sizeof(Real), static_cast<Real>(affine.rows[n / 4][n % 4]));
    code_ = header.frame == Frame::kUnknown ? kAligned : kScanner;
    qform_code_ = qform.exists ? code_ : 0;
  }
  int code() const { return code_; }
  int qform_code() const { return qform_code_; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  int code_ = 0, qform_code_ = 0;
};

std::string header_1(const VolumeHeader& header) {
  HeaderWriter out(kNifti1HeaderSize);
  out.put<std::int32_t>(0, kNifti1HeaderSize);
  out.put<std::int16_t>(40, 3);
  for (int n = 0; n < 7; ++n) out.put(42 + 2 * n, static_cast<std::int16_t>(n < 3 ? header.dims[n] : 1));
  out.put<std::int16_t>(70, kFloat32);
  out.put<std::int16_t>(72, 32);
  out.put<float>(108, static_cast<float>(kNifti1HeaderSize + kExtensionFlagSize));
  out.put<float>(112, 1);
  out.put<std::uint8_t>(123, kUnitMm);
  out.put_geometry<float>(header, 76, 256, 280);
  out.put(252, static_cast<std::int16_t>(out.qform_code()));
  out.put(254, static_cast<std::int16_t>(out.code()));
  out.put_text(344, "n+1\0", 4);
  return out.bytes();
}

std::string header_2(const VolumeHeader& header) {
  HeaderWriter out(kNifti2HeaderSize);
  out.put<std::int32_t>(0, kNifti2HeaderSize);
  out.put_text(4, "n+2\0\r\n\x1a\n", 8);
  out.put<std::int16_t>(12, kFloat32);
  out.put<std::int16_t>(14, 32);
  out.put<std::int64_t>(16, 3);
  for (int n = 0; n < 7; ++n) out.put(24 + 8 * n, std::int64_t{n < 3 ? header.dims[n] : 1});
  out.put<std::int64_t>(168, kNifti2HeaderSize + kExtensionFlagSize);
  out.put<double>(176, 1);
  out.put_geometry<double>(header, 104, 352, 400);
  out.put<std::int32_t>(344, out.qform_code());
  out.put<std::int32_t>(348, out.code());
  out.put<std::int32_t>(500, kUnitMm);
  return out.bytes();
}

/// Deflates into a gzip member without name or date, so that the same volume gives the same bytes.
class GzipWriter {
 public:
  explicit GzipWriter(std::ostream& out) : out_(out), buffer_(std::size_t{1} << 18) {
    constexpr int kGzip = 15 + 16, kLevel = 4, kMemory = 8;
    if (deflateInit2(&stream_, kLevel, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  }
  ~GzipWriter() { deflateEnd(&stream_); }
  GzipWriter(const GzipWriter&) = delete;
  GzipWriter& operator=(const GzipWriter&) = delete;

  void write(const char* data, std::size_t size) {
    constexpr std::size_t kLargestPiece = std::size_t{1} << 30;  // zlib counts in 32 bits
    while (size > 0) {
      const std::size_t piece = std::min(size, kLargestPiece);
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data));
      stream_.avail_in = static_cast<uInt>(piece);
      run(Z_NO_FLUSH);
      data += piece;
      size -= piece;
    }
  }
  void finish() { run(Z_FINISH); }

 private:
  void run(int flush) {
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
      stream_.avail_out = static_cast<uInt>(buffer_.size());
      deflate(&stream_, flush);
      out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size() - stream_.avail_out));
    } while (stream_.avail_out == 0);
  }

  std::ostream& out_;
  z_stream stream_{};
  std::vector<char> buffer_;
};

}  // namespace

void write_nifti(const Volume& volume, const std::filesystem::path& path, bool compressed) {
  constexpr int kLargestDim1 = 32767;
  const std::array<int, 3>& dims = volume.dims();
  const bool fits_1 = *std::max_element(dims.begin(), dims.end()) <= kLargestDim1;
  const std::string header = fits_1 ? header_1(volume.header()) : header_2(volume.header());
  OutputFile file(path);
  if (compressed) {
    GzipWriter gzip(file.stream());
    gzip.write(header.data(), header.size());
    for_each_slab(volume, [&](const float* samples, int, std::size_t count) {
      gzip.write(reinterpret_cast<const char*>(samples), count * sizeof(float));
    });
    gzip.finish();
  } else {
    file.stream().write(header.data(), static_cast<std::streamsize>(header.size()));
    for_each_slab(volume, [&](const float* samples, int, std::size_t count) {
      file.stream().write(reinterpret_cast<const char*>(samples), static_cast<std::streamsize>(count * sizeof(float)));
    });
  }
  file.commit();
}

}  // namespace delvox
