#include "mesh_io/hdf5_image.h"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

namespace delvox::mesh_io {
namespace {

/// A handle of the library, closed with the object.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(checked(id)), close_(close) {}
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: it stands for the identifier

  static hid_t checked(hid_t id) {
    if (id < 0) throw std::runtime_error("HDF5 could not make a file in memory");
    return id;
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

Handle without_times(hid_t object_class) {
  const hid_t properties = H5Pcreate(object_class);
  if (properties >= 0) H5Pset_obj_track_times(properties, false);
  return {properties, H5Pclose};
}

void write_array(hid_t file, const std::string& path, hid_t type, const void* values, std::size_t count,
                 std::size_t columns) {
  const std::array<hsize_t, 2> dims{columns == 0 ? count : count / columns, columns};
  const Handle space(H5Screate_simple(columns == 0 ? 1 : 2, dims.data(), nullptr), H5Sclose);
  const Handle properties = without_times(H5P_DATASET_CREATE);
  const Handle set(H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  if (count > 0) Handle::checked(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
}

void write_attribute(hid_t file, const std::string& path, const char* name, hid_t type, const void* value) {
  const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  Handle::checked(H5Awrite(attribute, type, value));
}

}  // namespace

Hdf5Image::Hdf5Image() {
  constexpr std::size_t kGrowth = std::size_t{1} << 22;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, kGrowth, false);
  const Handle creation = without_times(H5P_FILE_CREATE);
  file_ = Handle::checked(H5Fcreate("delvox.h5", H5F_ACC_TRUNC, creation, access));
}

Hdf5Image::~Hdf5Image() {
  H5Fclose(file_);
}

void Hdf5Image::group(const std::string& path) {
  const Handle properties = without_times(H5P_GROUP_CREATE);
  const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose);
}

void Hdf5Image::array(const std::string& path, std::span<const double> values, std::size_t columns) {
  write_array(file_, path, H5T_NATIVE_DOUBLE, values.data(), values.size(), columns);
}
void Hdf5Image::array(const std::string& path, std::span<const std::int32_t> values, std::size_t columns) {
  write_array(file_, path, H5T_NATIVE_INT32, values.data(), values.size(), columns);
}
void Hdf5Image::array(const std::string& path, std::span<const std::int64_t> values, std::size_t columns) {
  write_array(file_, path, H5T_NATIVE_INT64, values.data(), values.size(), columns);
}

void Hdf5Image::names(const std::string& path, std::span<const std::string> names) {
  constexpr std::size_t kLength = 80;
  std::vector<char> bytes(kLength * names.size(), 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::copy_n(names[i].begin(), std::min(names[i].size(), kLength - 1),
                bytes.begin() + static_cast<long>(kLength * i));
  }
  const hsize_t length = kLength;
  const Handle type(H5Tarray_create2(H5T_NATIVE_INT8, 1, &length), H5Tclose);
  write_array(file_, path, type, bytes.data(), names.size(), 0);
}

void Hdf5Image::attribute(const std::string& path, const char* name, std::int32_t value) {
  write_attribute(file_, path, name, H5T_NATIVE_INT32, &value);
}
void Hdf5Image::attribute(const std::string& path, const char* name, double value) {
  write_attribute(file_, path, name, H5T_NATIVE_DOUBLE, &value);
}
void Hdf5Image::attribute(const std::string& path, const char* name, const std::string& value, std::size_t size) {
  std::string padded = value.substr(0, size);
  padded.resize(size + 1, '\0');
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, size + 1);
  write_attribute(file_, path, name, type, padded.data());
}

std::string Hdf5Image::bytes() const {
  H5Fflush(file_, H5F_SCOPE_GLOBAL);
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  if (size < 0) throw std::runtime_error("HDF5 could not make a file in memory");
  std::string image(static_cast<std::size_t>(size), '\0');
  H5Fget_file_image(file_, image.data(), image.size());
  return image;
}

}  // namespace delvox::mesh_io
