#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_io/xml.h"

namespace delvox::mesh_io {

/// Decodes the DataArrays of a VTU file: text, base64 or raw appended, zlib blocks or plain, any number type.
class VtuArrays {
 public:
  /// `root` is the VTKFile element; `appended` what follows the '_' of AppendedData. Throws InputError.
  VtuArrays(const Source& source, const XmlNode& root, std::string_view appended, bool appended_is_base64);

  std::vector<double> reals(const XmlNode& array) { return numbers<double>(array); }
  std::vector<std::int64_t> integers(const XmlNode& array) { return numbers<std::int64_t>(array); }

 private:
  class Bytes;

  template <class T>
  std::vector<T> numbers(const XmlNode& array);
  std::string binary(const XmlNode& array);
  std::string decompress(Bytes& bytes);
  void spend(std::uint64_t bytes);
  std::uint64_t header_number(const std::string& bytes, std::size_t index) const;

  const Source& source_;
  std::string_view appended_;
  bool appended_is_base64_;
  bool compressed_;
  std::size_t header_size_;
  std::endian order_;
  std::uint64_t budget_;  ///< bytes that may still be decoded
};

}  // namespace delvox::mesh_io
