#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/ids.h"

namespace delvox {

/// A number for each of a few keys, forgotten at once by clear(). A table of its own, not fields of cells or vertices:
/// several threads can have one each, and it stays in the nearest cache.
class SmallMap {
 public:
  SmallMap() : entries_(kFirstSize) {}

  void clear() {
    size_ = 0;
    if (++round_ != 0) return;
    entries_.assign(entries_.size(), {});
    round_ = 1;
  }

  /// The key's number; make() gives it if the key is new. make() may not use the map.
  template <class Make>
  std::uint32_t find_or(std::uint32_t key, const Make& make) {
    if (2 * size_ >= entries_.size()) grow();
    Entry& entry = place_of(key);
    if (entry.round != round_) {
      entry = {key, round_, static_cast<std::uint32_t>(make())};
      ++size_;
    }
    return entry.number;
  }

 private:
  static constexpr std::size_t kFirstSize = 256;
  struct Entry {
    std::uint32_t key = kNone, round = 0, number = 0;
  };

  /// Where the key is, or the free place for it.
  Entry& place_of(std::uint32_t key) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t place = (key * std::uint64_t{0x9e3779b97f4a7c15} >> 32) & mask;
    while (entries_[place].round == round_ && entries_[place].key != key) place = (place + 1) & mask;
    return entries_[place];
  }

  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    old.swap(entries_);
    for (const Entry& entry : old) {
      if (entry.round == round_) place_of(entry.key) = entry;
    }
  }

  std::vector<Entry> entries_;  // a power of two of them
  std::size_t size_ = 0;
  std::uint32_t round_ = 1;
};

}  // namespace delvox
