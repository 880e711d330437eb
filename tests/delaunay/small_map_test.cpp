#include "delaunay/small_map.h"

#include <gtest/gtest.h>

#include <unordered_map>

#include "support/random.h"

namespace delvox {
namespace {

TEST(SmallMap, KnowsWhatWasMadeSinceItWasClearedHoweverOftenThatIs) {
  test::Random random(1);
  SmallMap map;
  for (int round = 0; round < 2000; ++round) {  // more than an entry can number
    map.clear();
    std::unordered_map<std::uint32_t, std::uint32_t> expected;
    const int keys = round % 97 == 0 ? 3000 : 40;
    for (int n = 0; n < 2 * keys; ++n) {
      const auto key = static_cast<std::uint32_t>(random.below(keys)) * 0x1000193u;
      const auto made = static_cast<std::uint32_t>(random.below(SmallMap::kMostNumber + 1));
      const auto [known, is_new] = expected.emplace(key, made);
      ASSERT_EQ(map.find_or(key, [&] { return made; }), known->second) << round;
    }
  }
}

TEST(SmallMap, KeepsWhatItHoldsAsItGrows) {
  SmallMap map;
  map.clear();
  for (std::uint32_t key = 0; key < 500; ++key) map.find_or(key, [&] { return key + 1; });
  const SmallMap::Table table = map.table_for(100000);
  for (std::uint32_t key = 0; key < 500; ++key) {
    const SmallMap::Entry entry = table.place_of(key);
    ASSERT_TRUE(table.known(entry));
    EXPECT_EQ(SmallMap::Table::number(entry), key + 1);
  }
  EXPECT_FALSE(table.known(table.place_of(500)));
}

}  // namespace
}  // namespace delvox
