#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/hash.h"

namespace delvox {

/// A map from 64-bit keys to 32-bit numbers by open addressing: a fraction of std::unordered_map's time, because
/// entries lie side by side, and those whose keys differ in their low bits only lie near each other. Keys are never
/// removed; kEmptyKey is not a key.
class FlatHash {
 public:
  static constexpr std::uint64_t kEmptyKey = ~0ull;
  static constexpr std::uint32_t kAbsent = ~0u;

  /// The number of `key`, or kAbsent.
  std::uint32_t find(std::uint64_t key) const {
    if (slots_.empty()) return kAbsent;
    const Slot& slot = slots_[place(key)];
    return slot.key == key ? slot.number : kAbsent;
  }
  /// The number of `key`, which is made with number kAbsent if it is new. Valid until the next call.
  std::uint32_t& operator[](std::uint64_t key) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[place(key)];
    if (slot.key == kEmptyKey) {
      slot.key = key;
      ++count_;
    }
    return slot.number;
  }

 private:
  static constexpr int kNearBits = 11;
  struct Slot {
    std::uint64_t key = kEmptyKey;
    std::uint32_t number = kAbsent;
  };

  std::size_t place(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = (mix_hash(key >> kNearBits) + (key & ((1u << kNearBits) - 1))) & mask;
    while (slots_[i].key != kEmptyKey && slots_[i].key != key) i = (i + 1) & mask;
    return i;
  }
  void grow() {
    std::vector<Slot> old(slots_.empty() ? 64 : 2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.key != kEmptyKey) slots_[place(slot.key)] = slot;
    }
  }

  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace delvox
