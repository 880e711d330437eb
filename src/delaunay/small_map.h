#pragma once

#include <cstdint>
#include <vector>

#include "delaunay/ids.h"

namespace delvox {

/// A number for each of a few keys, forgotten at once by clear(). A table of its own, not fields of cells or vertices:
/// several threads can have one each, and it stays in the nearest cache.
class SmallMap {
 public:
  /// The round when it was made, the number and the key in one word, so that all is read and compared at once.
  using Entry = std::uint64_t;
  static constexpr std::uint32_t kMostNumber = 0xffffff;

  /// The table for a loop that is to keep it in registers; valid until the map is asked for another.
  class Table {
   public:
    /// Where the key is, or the free place for it.
    Entry& place_of(std::uint32_t key) const {
      std::uint32_t place = static_cast<std::uint32_t>(key * std::uint64_t{0x9e3779b97f4a7c15} >> 40) & mask_;
      while (known(entries_[place]) && static_cast<std::uint32_t>(entries_[place]) != key) place = (place + 1) & mask_;
      return entries_[place];
    }
    bool known(Entry entry) const { return entry >> kRoundAt == round_; }
    static std::uint32_t number(Entry entry) { return static_cast<std::uint32_t>(entry >> kNumberAt) & kMostNumber; }
    Entry made(std::uint32_t key, std::uint32_t number) const {
      return std::uint64_t{round_} << kRoundAt | std::uint64_t{number} << kNumberAt | key;
    }

   private:
    friend class SmallMap;
    Table(Entry* entries, std::uint32_t mask, std::uint32_t round) : entries_(entries), mask_(mask), round_(round) {}
    Entry* entries_;
    std::uint32_t mask_, round_;
  };

  SmallMap() : entries_(std::size_t{1} << kFirstBits) {}

  void clear() {
    size_ = 0;
    if (++round_ <= kLastRound) return;
    entries_.assign(entries_.size(), 0);
    round_ = 1;
  }

  /// With room for so many keys more, which count as there from now on.
  Table table_for(std::uint32_t keys) {
    size_ += keys;
    if (size_ > mask_ / 4) grow();
    return table();
  }

  /// The key's number; make() gives it if the key is new. make() may not use the map. pre: numbers are at most
  /// kMostNumber.
  template <class Make>
  std::uint32_t find_or(std::uint32_t key, const Make& make) {
    const Table own = table();
    Entry& entry = own.place_of(key);
    if (own.known(entry)) return Table::number(entry);
    const std::uint32_t number = make();
    entry = own.made(key, number);
    table_for(1);
    return number;
  }

 private:
  static constexpr int kFirstBits = 8, kRoundAt = 56, kNumberAt = 32;
  static constexpr std::uint32_t kLastRound = 0xff;

  Table table() { return {entries_.data(), mask_, round_}; }

  [[gnu::noinline]] void grow() {
    while (size_ > mask_ / 4) mask_ = 2 * mask_ + 1;
    std::vector<Entry> old(std::size_t{mask_} + 1);
    old.swap(entries_);
    const Table own = table();
    for (const Entry& entry : old) {
      if (own.known(entry)) own.place_of(static_cast<std::uint32_t>(entry)) = entry;
    }
  }

  std::vector<Entry> entries_;  // a power of two of them
  std::uint32_t mask_ = (1u << kFirstBits) - 1, size_ = 0, round_ = 1;
};

}  // namespace delvox
