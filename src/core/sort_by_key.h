#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace delvox {

/// Stands for an item that is held elsewhere.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts items by their 64-bit `key`, those of equal keys staying in the order in which they are: by counting, eleven
/// bits after eleven, which takes a fraction of the time of comparing.
template <class Item>
void sort_by_key(std::vector<Item>& items) {
  constexpr int kBits = 11, kDigits = 6;
  constexpr std::size_t kValues = std::size_t{1} << kBits;
  const auto digit = [](const Item& item, int d) { return item.key >> (kBits * d) & (kValues - 1); };
  std::vector<std::array<std::uint32_t, kValues>> counts(kDigits);
  for (const Item& item : items) {
    for (int d = 0; d < kDigits; ++d) ++counts[d][digit(item, d)];
  }
  std::vector<Item> sorted(items.size());
  for (int d = 0; d < kDigits && !items.empty(); ++d) {
    if (counts[d][digit(items.front(), d)] == items.size()) continue;  // all have the same
    std::uint32_t first = 0;
    for (std::uint32_t& count : counts[d]) first += std::exchange(count, first);
    for (const Item& item : items) sorted[counts[d][digit(item, d)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace delvox
