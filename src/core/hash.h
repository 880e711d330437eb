#pragma once

#include <cstdint>

namespace delvox {

/// SplitMix64's finaliser (Steele, Lea, Flood 2014): each input bit changes about half of the output bits.
inline std::uint64_t mix_hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// A hash as a number in [0, 1).
inline double unit_interval(std::uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1.0p-53; }

}  // namespace delvox
