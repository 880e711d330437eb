#include "core/sort_by_key.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/random.h"

namespace delvox {
namespace {

struct Item {
  std::uint64_t key;
  std::uint32_t place;
  friend bool operator==(const Item&, const Item&) = default;
};

/// With `bits` bits from bit `shift` on that differ.
std::vector<Item> random_items(std::size_t count, int bits, int shift) {
  test::Random random(count);
  std::vector<Item> items(count);
  for (std::uint32_t i = 0; i < count; ++i) items[i] = {(random.bits() >> (64 - bits)) << shift, i};
  return items;
}

TEST(SortByKey, SortsAsAStableSortDoes) {
  for (const std::size_t count : {0u, 1u, 2u, 100u, 5000u, 100000u}) {
    for (const auto& [bits, shift] : {std::pair(64, 0), {3, 0}, {12, 40}, {1, 63}, {48, 7}}) {
      std::vector<Item> items = random_items(count, bits, shift), expected = items;
      std::stable_sort(expected.begin(), expected.end(), [](const Item& a, const Item& b) { return a.key < b.key; });
      sort_by_key(items);
      EXPECT_EQ(items, expected) << count << " items of " << bits << " bits";
    }
  }
}

TEST(SortByKey, LeavesEqualKeysInTheirOrder) {
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < 3000; ++i) items.push_back({0xfedcba9876543210u, i});
  const std::vector<Item> before = items;
  sort_by_key(items);
  EXPECT_EQ(items, before);
}

}  // namespace
}  // namespace delvox
