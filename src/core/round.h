#pragma once

#include <cstdint>

namespace delvox {

/// std::floor and std::ceil of numbers within the range of integers, without what these are where a processor need not
/// have an instruction for them: calls.
inline std::int64_t floor_to_int(double x) {
  const auto truncated = static_cast<std::int64_t>(x);
  return truncated - (static_cast<double>(truncated) > x);
}
inline std::int64_t ceil_to_int(double x) { return -floor_to_int(-x); }

}  // namespace delvox
