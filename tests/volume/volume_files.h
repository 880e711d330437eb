#pragma once

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "delvox/core/errors.h"
#include "delvox/volume/read_volume.h"

/// Builders of small volume files, byte by byte, for the readers' tests.
namespace delvox::testing {

namespace fs = std::filesystem;

/// A folder of its own for a test, gone with it.
class TempFolder {
 public:
  TempFolder() {
    std::string name = (fs::temp_directory_path() / "delvox-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TempFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  fs::path operator/(const std::string& name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

inline fs::path write_file(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

inline std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(bytes.size() + bytes.size() / 100 + 1024, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// The bytes of a value in either order.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

template <class T>
std::string bytes_of_all(const std::vector<T>& values, bool big_endian = false) {
  std::string bytes;
  for (T value : values) bytes += bytes_of(value, big_endian);
  return bytes;
}

/// A NIfTI header with sensible fields that a test then changes.
struct NiftiFile {
  int version = 1;
  bool big_endian = false;
  bool pair = false;
  std::array<std::int64_t, 8> dim{3, 2, 3, 4, 1, 1, 1, 1};
  int datatype = 2, bitpix = 8;
  std::array<double, 8> pixdim{1, 1, 1, 1, 1, 1, 1, 1};
  double vox_offset = -1;  // -1: right behind the header
  double slope = 0, intercept = 0;
  int units = 2, qform_code = 0, sform_code = 1;
  std::array<double, 6> quatern{};
  std::array<double, 12> srow{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  std::string payload;

  std::string header() const { return version == 1 ? header_1() : header_2(); }
  std::string bytes() const { return header() + std::string(4, '\0') + payload; }

 private:
  template <class T>
  void put(std::string& out, std::size_t offset, T value) const {
    out.replace(offset, sizeof(T), bytes_of(value, big_endian));
  }
  template <class Real>
  void put_reals(std::string& out, std::array<std::size_t, 5> at) const {
    for (int n = 0; n < 8; ++n) put(out, at[0] + n * sizeof(Real), static_cast<Real>(pixdim[n]));
    put(out, at[1], static_cast<Real>(slope));
    put(out, at[2], static_cast<Real>(intercept));
    for (int n = 0; n < 6; ++n) put(out, at[3] + n * sizeof(Real), static_cast<Real>(quatern[n]));
    for (int n = 0; n < 12; ++n) put(out, at[4] + n * sizeof(Real), static_cast<Real>(srow[n]));
  }
  double offset() const { return vox_offset >= 0 ? vox_offset : pair ? 0 : version == 1 ? 352 : 544; }
  std::string header_1() const {
    std::string out(348, '\0');
    put<std::int32_t>(out, 0, 348);
    for (int n = 0; n < 8; ++n) put(out, 40 + 2 * n, static_cast<std::int16_t>(dim[n]));
    put(out, 70, static_cast<std::int16_t>(datatype));
    put(out, 72, static_cast<std::int16_t>(bitpix));
    put(out, 108, static_cast<float>(offset()));
    put(out, 123, static_cast<std::uint8_t>(units));
    put(out, 252, static_cast<std::int16_t>(qform_code));
    put(out, 254, static_cast<std::int16_t>(sform_code));
    put_reals<float>(out, {76, 112, 116, 256, 280});
    out.replace(344, 4, std::string(pair ? "ni1\0" : "n+1\0", 4));
    return out;
  }
  std::string header_2() const {
    std::string out(540, '\0');
    put<std::int32_t>(out, 0, 540);
    out.replace(4, 8, std::string(pair ? "ni2\0\r\n\x1a\n" : "n+2\0\r\n\x1a\n", 8));
    put(out, 12, static_cast<std::int16_t>(datatype));
    put(out, 14, static_cast<std::int16_t>(bitpix));
    for (int n = 0; n < 8; ++n) put(out, 16 + 8 * n, dim[n]);
    put(out, 168, static_cast<std::int64_t>(offset()));
    put(out, 344, static_cast<std::int32_t>(qform_code));
    put(out, 348, static_cast<std::int32_t>(sform_code));
    put(out, 500, static_cast<std::int32_t>(units));
    put_reals<double>(out, {104, 176, 184, 352, 400});
    return out;
  }
};

/// 0, 1, 2, ... of a type, as a payload.
template <class T>
std::string counting_payload(std::size_t count, bool big_endian = false) {
  std::vector<T> values;
  for (std::size_t n = 0; n < count; ++n) values.push_back(static_cast<T>(n));
  return bytes_of_all(values, big_endian);
}

inline std::vector<float> counting_samples(std::size_t count) {
  std::vector<float> values;
  for (std::size_t n = 0; n < count; ++n) values.push_back(static_cast<float>(n));
  return values;
}

/// The message with which reading fails, or "" if it succeeds.
inline std::string read_error(const fs::path& path, const ReadVolumeOptions& options = {}) {
  try {
    read_volume(path, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

inline bool warns(const Volume& volume, const std::string& part) {
  const auto& warnings = volume.header().warnings;
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace delvox::testing
