#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>

#include "mesh_io/binary.h"

namespace delvox::mesh_io {

/// A double to be written with 12 significant digits: at most 19 characters, what a solver's field holds.
struct Digits12 {
  double value;
};

/// Buffered output of text and numbers, some ten times faster than operator<< and independent of any locale.
/// Whether the stream took the bytes is checked by OutputFile::commit().
class Out {
 public:
  explicit Out(std::ostream& stream) : stream_(stream) { buffer_.reserve(kFlushAt + 4096); }
  ~Out() { flush(); }
  Out(const Out&) = delete;
  Out& operator=(const Out&) = delete;

  /// Each item as text. Doubles get the fewest digits that read back as the same double.
  template <class... Items>
  void put(const Items&... items) {
    (append(items), ...);
    if (buffer_.size() >= kFlushAt) flush();
  }
  void bytes(std::string_view data) {
    flush();
    stream_.write(data.data(), static_cast<std::streamsize>(data.size()));
  }
  /// One number in binary.
  template <class T>
  void binary(T value, std::endian order) {
    if (order != std::endian::native) value = byte_swapped(value);
    buffer_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    if (buffer_.size() >= kFlushAt) flush();
  }
  void flush() {
    stream_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

 private:
  static constexpr std::size_t kFlushAt = std::size_t{1} << 20;

  void append(std::string_view text) { buffer_ += text; }
  void append(char c) { buffer_ += c; }
  void append(std::integral auto value) { append_chars(value); }
  void append(double value) { append_chars(value); }
  void append(Digits12 number) { append_chars(number.value, std::chars_format::general, 12); }

  template <class... Arguments>
  void append_chars(Arguments... arguments) {
    char text[40];
    const auto result = std::to_chars(text, text + sizeof text, arguments...);
    buffer_.append(text, result.ptr);
  }

  std::ostream& stream_;
  std::string buffer_;
};

}  // namespace delvox::mesh_io
