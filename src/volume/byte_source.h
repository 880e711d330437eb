#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace delvox {

/// The bytes of a regular file in order, inflated on the fly if it begins as gzip does (members may follow each
/// other). Every error is an InputError that names the file.
class ByteSource {
 public:
  /// Throws InputError: missing, a folder, not a regular file, not readable, empty.
  explicit ByteSource(std::filesystem::path path);
  ~ByteSource();
  ByteSource(ByteSource&&) noexcept;
  ByteSource& operator=(ByteSource&&) = delete;

  const std::filesystem::path& path() const;
  bool compressed() const;
  /// The first `size` bytes, or fewer if there are fewer; nothing is consumed. pre: nothing was read yet.
  std::string peek(std::size_t size);
  /// Fills out; returns fewer bytes than asked for only where the data end.
  std::size_t read(void* out, std::size_t size);
  /// As read(), but throws InputError "truncated" if they end early; `what` is being read, e.g. "the header".
  void read_exactly(void* out, std::size_t size, const char* what);
  void skip(std::uint64_t size, const char* what);
  /// No more bytes than this can be in the file, those already read included. gzip does not say what it expands to,
  /// but deflate never does so by more than 1032:1.
  std::uint64_t capacity() const;
  /// Bytes handed out so far, skipped ones included.
  std::uint64_t position() const;
  /// For gzip whose payload was read to its end: reads on to the checksum, which zlib compares, if it is near.
  void verify_end();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delvox
