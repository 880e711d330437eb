#include "mesh_io/vtu_data.h"

#include <libdeflate.h>

#include <array>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "mesh_io/number_type.h"

namespace delvox::mesh_io {
namespace {

// No zlib stream expands further than this: a block that claims to is lying.
constexpr std::uint64_t kMostExpansion = 1100;
// Arrays may share data and blocks may hold nothing but zeros: without a limit for the whole file, a small one could
// fill the memory. Even a regular lattice of a million tets, as we write it, expands only sixfold.
constexpr std::uint64_t kMostExpansionOfAll = 300, kAlwaysAllowed = 1 << 20;

constexpr std::array<signed char, 256> make_base64_values() {
  std::array<signed char, 256> values{};
  for (signed char& value : values) value = -1;
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<signed char>(i);
  }
  return values;
}
constexpr std::array<signed char, 256> kBase64Values = make_base64_values();

NumberType number_type(const Source& source, std::string_view name) {
  constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"Float64", NumberType::kFloat64}, {"Float32", NumberType::kFloat32}, {"Int64", NumberType::kInt64},
      {"UInt64", NumberType::kUInt64},   {"Int32", NumberType::kInt32},     {"UInt32", NumberType::kUInt32},
      {"Int16", NumberType::kInt16},     {"UInt16", NumberType::kUInt16},   {"Int8", NumberType::kInt8},
      {"UInt8", NumberType::kUInt8},
  };
  for (const auto& [type_name, type] : kTypes) {
    if (name == type_name) return type;
  }
  source.fail("an array has the unknown type " + in_quotes(name));
}

}  // namespace

/// Bytes one after the other, out of raw data or base64. Padding may stand in the middle: VTK encodes headers apart.
class VtuArrays::Bytes {
 public:
  Bytes(const Source& source, std::string_view text, bool base64) : source_(source), text_(text), base64_(base64) {}

  std::string take(std::uint64_t size) {
    const std::uint64_t left = base64_ ? text_.size() / 4 * 3 + pending_.size() : text_.size();
    if (size > left) source_.fail("an array claims " + std::to_string(size) + " bytes and has " + std::to_string(left));
    std::string result;
    if (!base64_) {
      result = text_.substr(0, size);
      text_.remove_prefix(size);
      return result;
    }
    result.swap(pending_);
    result.reserve(size + 3);
    while (result.size() < size) decode_four(result);
    pending_ = result.substr(size);
    result.resize(size);
    return result;
  }

 private:
  void decode_four(std::string& to) {
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
      if (text_.empty()) source_.fail("base64 data end too early");
      const char c = text_.front();
      text_.remove_prefix(1);
      if (is_blank(c)) continue;
      const int value = kBase64Values[static_cast<unsigned char>(c)];
      if (c == '=') {
        ++padding;
      } else if (value < 0 || padding > 0) {
        source_.fail("base64 data hold " + in_quotes({&c, 1}));
      } else {
        ++digits;
        bits = bits << 6 | static_cast<std::uint32_t>(value);
      }
    }
    if (digits < 2) source_.fail("base64 data end too early");
    bits <<= 6 * padding;
    for (int i = 0; i < digits - 1; ++i) to += static_cast<char>(bits >> (16 - 8 * i) & 255);
  }

  const Source& source_;
  std::string_view text_;
  bool base64_;
  std::string pending_;
};

VtuArrays::VtuArrays(const Source& source, const XmlNode& root, std::string_view appended, bool appended_is_base64)
    : source_(source),
      appended_(appended),
      appended_is_base64_(appended_is_base64),
      order_(root.attribute("byte_order") == "BigEndian" ? std::endian::big : std::endian::little) {
  const std::string_view compressor = root.attribute("compressor");
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    source.fail("is compressed with " + in_quotes(compressor), "save it with zlib compression or none");
  }
  compressed_ = !compressor.empty();
  budget_ = kAlwaysAllowed + (compressed_ ? kMostExpansionOfAll : 1) * source.bytes.size();
  const std::string_view header = root.attribute("header_type", "UInt32");
  if (header != "UInt32" && header != "UInt64") source.fail("has the unknown header_type " + in_quotes(header));
  header_size_ = header == "UInt64" ? 8 : 4;
}

std::uint64_t VtuArrays::header_number(const std::string& bytes, std::size_t index) const {
  const char* at = bytes.data() + index * header_size_;
  return header_size_ == 8 ? load<std::uint64_t>(at, order_) : load<std::uint32_t>(at, order_);
}

void VtuArrays::spend(std::uint64_t bytes) {
  if (bytes > budget_) source_.fail("its arrays expand to an impossible size");
  budget_ -= bytes;
}

std::string VtuArrays::decompress(Bytes& bytes) {
  const std::string head = bytes.take(3 * header_size_);
  const std::uint64_t blocks = header_number(head, 0), block_size = header_number(head, 1);
  const std::uint64_t partial_size = header_number(head, 2);
  if (blocks > source_.bytes.size() / header_size_) source_.fail("an array claims too many compressed blocks");
  const std::string sizes = bytes.take(blocks * header_size_);
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  std::string result;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t packed_size = header_number(sizes, b);
    const std::string packed = bytes.take(packed_size);
    const std::uint64_t full_size = b + 1 == blocks && partial_size != 0 ? partial_size : block_size;
    if (full_size > kMostExpansion * (packed_size + 1)) source_.fail("a compressed block claims an impossible size");
    spend(full_size);
    const std::size_t start = result.size();
    result.resize(start + full_size);
    const libdeflate_result status = libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(),
                                                                result.data() + start, full_size, nullptr);
    if (status != LIBDEFLATE_SUCCESS) source_.fail("a compressed block is damaged");
  }
  return result;
}

std::string VtuArrays::binary(const XmlNode& array) {
  std::string_view text = array.text;
  bool base64 = true;
  if (array.attribute("format") == "appended") {
    const std::int64_t offset = parse_integer(source_, trimmed(array.attribute("offset")));
    if (offset < 0 || static_cast<std::uint64_t>(offset) > appended_.size()) {
      source_.fail("an array lies beyond the end of the appended data");
    }
    text = appended_.substr(static_cast<std::size_t>(offset));
    base64 = appended_is_base64_;
  }
  Bytes bytes(source_, text, base64);
  if (compressed_) return decompress(bytes);
  const std::string head = bytes.take(header_size_);
  const std::uint64_t size = header_number(head, 0);
  spend(size);
  return bytes.take(size);
}

template <class T>
std::vector<T> VtuArrays::numbers(const XmlNode& array) {
  const std::string_view format = array.attribute("format", "ascii");
  if (format == "binary" || format == "appended") {
    return load_all_as<T>(source_, binary(array), number_type(source_, array.attribute("type")), order_);
  }
  if (format != "ascii") source_.fail("an array has the unknown format " + in_quotes(format));
  std::vector<T> result;
  TextCursor cursor(source_, array.text);
  while (cursor.more()) {
    if constexpr (std::is_integral_v<T>) {
      result.push_back(cursor.integer());
    } else {
      result.push_back(cursor.real());
    }
  }
  return result;
}

template std::vector<double> VtuArrays::numbers(const XmlNode&);
template std::vector<std::int64_t> VtuArrays::numbers(const XmlNode&);

}  // namespace delvox::mesh_io
