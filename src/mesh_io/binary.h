#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace delvox::mesh_io {

/// `value` with its bytes in the order of a machine of the other kind.
template <class T>
T byte_swapped(T value) {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// The T stored at `from`, which need not be aligned.
template <class T>
T load(const char* from, std::endian order) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return order == std::endian::native ? value : byte_swapped(value);
}

}  // namespace delvox::mesh_io
