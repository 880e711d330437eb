#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/hash.h"
#include "delaunay/ids.h"

namespace delvox {

/// Pairs up the two sides of each edge of a closed triangulated surface.
class EdgeMatcher {
 public:
  static constexpr std::uint32_t kFirst = 0xffffffffu;

  /// Starts anew, for `edges` edges at most.
  void begin(std::size_t edges) {
    const std::size_t wanted = std::bit_ceil(2 * edges + 1);
    if (wanted > slots_.size()) {
      slots_.assign(wanted, Slot{});
      round_ = 0;
    }
    ++round_;
    mask_ = wanted - 1;
  }

  /// The side that was given for the edge before, or kFirst.
  std::uint32_t match(VertexId a, VertexId b, std::uint32_t side) {
    const auto [low, high] = std::minmax(a, b);
    const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | high;
    std::size_t i = (key * 0x9e3779b97f4a7c15ull) >> 32 & mask_;
    while (slots_[i].round == round_ && slots_[i].key != key) i = (i + 1) & mask_;
    if (slots_[i].round == round_) return slots_[i].side;
    slots_[i] = {key, side, round_};
    return kFirst;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t side = 0, round = 0;
  };
  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::uint32_t round_ = 0;
};

}  // namespace delvox
