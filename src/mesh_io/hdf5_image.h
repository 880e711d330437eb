#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace delvox::mesh_io {

/// An HDF5 file made in memory, without times, so that its bytes depend on what is put into it alone. Paths are like
/// "/Mesh/mesh/geometry"; their groups must exist.
class Hdf5Image {
 public:
  Hdf5Image();
  ~Hdf5Image();
  Hdf5Image(const Hdf5Image&) = delete;
  Hdf5Image& operator=(const Hdf5Image&) = delete;

  void group(const std::string& path);
  /// Arrays of rows x columns, or of rows if columns is 0.
  void array(const std::string& path, std::span<const double> values, std::size_t columns = 0);
  void array(const std::string& path, std::span<const std::int32_t> values, std::size_t columns = 0);
  void array(const std::string& path, std::span<const std::int64_t> values, std::size_t columns = 0);
  /// Texts of 80 bytes each, as arrays of 80 small integers.
  void names(const std::string& path, std::span<const std::string> names);

  void attribute(const std::string& path, const char* name, std::int32_t value);
  void attribute(const std::string& path, const char* name, double value);
  /// A text padded with zeros to `size` bytes.
  void attribute(const std::string& path, const char* name, const std::string& value, std::size_t size);

  /// The bytes of the file.
  std::string bytes() const;

 private:
  std::int64_t file_;
};

}  // namespace delvox::mesh_io
