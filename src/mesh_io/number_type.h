#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

#include "mesh_io/binary.h"
#include "mesh_io/source.h"

namespace delvox::mesh_io {

enum class NumberType { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kInt64, kUInt64, kFloat32, kFloat64 };

/// Calls visit with a value of the C++ type that `type` stands for.
template <class Visitor>
decltype(auto) with_type(NumberType type, Visitor&& visit) {
  switch (type) {
    case NumberType::kInt8: return visit(std::int8_t{});
    case NumberType::kUInt8: return visit(std::uint8_t{});
    case NumberType::kInt16: return visit(std::int16_t{});
    case NumberType::kUInt16: return visit(std::uint16_t{});
    case NumberType::kInt32: return visit(std::int32_t{});
    case NumberType::kUInt32: return visit(std::uint32_t{});
    case NumberType::kInt64: return visit(std::int64_t{});
    case NumberType::kUInt64: return visit(std::uint64_t{});
    case NumberType::kFloat32: return visit(float{});
    case NumberType::kFloat64: break;
  }
  return visit(double{});
}

inline std::size_t size_of(NumberType type) {
  return with_type(type, [](auto example) { return sizeof example; });
}

/// The number at `from` as a T (double or int64). Throws InputError if T is whole and the number far out of its range.
template <class T>
T load_as(const Source& source, const char* from, NumberType type, std::endian order) {
  return with_type(type, [&](auto example) {
    const auto value = load<decltype(example)>(from, order);
    if constexpr (std::is_integral_v<T> && std::is_floating_point_v<decltype(example)>) {
      if (!(std::abs(value) < 9e15)) source.fail("a whole number was expected, another found");
    }
    return static_cast<T>(value);
  });
}

/// All of `bytes` as Ts. Throws InputError if they end within a number.
template <class T>
std::vector<T> load_all_as(const Source& source, std::string_view bytes, NumberType type, std::endian order) {
  const std::size_t size = size_of(type);
  if (bytes.size() % size != 0) source.fail("an array ends within a number");
  std::vector<T> result(bytes.size() / size);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = load_as<T>(source, bytes.data() + i * size, type, order);
  }
  return result;
}

}  // namespace delvox::mesh_io
