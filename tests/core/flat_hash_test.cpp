#include "core/flat_hash.h"

#include <gtest/gtest.h>

#include <unordered_map>

#include "support/random.h"

namespace delvox {
namespace {

TEST(FlatHash, AgreesWithUnorderedMapOverManyMixedCalls) {
  FlatHash hash;
  std::unordered_map<std::uint64_t, std::uint32_t> expected;
  test::Random random(1);
  for (std::uint32_t n = 0; n < 20000; ++n) {
    // Keys from a small range, so that many are met again; shifted, so that their low bits are alike.
    const std::uint64_t key = static_cast<std::uint64_t>(random.below(5000)) << 20;
    if (random.below(2) == 0) {
      hash[key] = n;
      expected[key] = n;
    }
    const std::uint64_t other = static_cast<std::uint64_t>(random.below(5000)) << 20;
    const auto known = expected.find(other);
    ASSERT_EQ(hash.find(other), known == expected.end() ? FlatHash::kAbsent : known->second);
  }
}

TEST(FlatHash, ANewKeyStartsAbsentAndTheExtremeKeysWork) {
  FlatHash hash;
  EXPECT_EQ(hash.find(0), FlatHash::kAbsent);
  EXPECT_EQ(hash[0], FlatHash::kAbsent);
  hash[0] = 7;
  hash[FlatHash::kEmptyKey - 1] = 8;
  EXPECT_EQ(hash.find(0), 7u);
  EXPECT_EQ(hash.find(FlatHash::kEmptyKey - 1), 8u);
  EXPECT_EQ(hash.find(1), FlatHash::kAbsent);
}

}  // namespace
}  // namespace delvox
