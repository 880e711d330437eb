#include "core/page_array.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace delvox {
namespace {

struct Pair {
  std::uint64_t a, b;
};

TEST(PageArray, IsEmptyAtFirstAndGrowingToNothingIsNoError) {
  PageArray<Pair> array;
  EXPECT_EQ(array.size(), 0u);
  array.grow_to(0);
  EXPECT_EQ(array.size(), 0u);
}

TEST(PageArray, KeepsItsElementsThroughManyGrowthsAndStartsNewOnesAsZero) {
  PageArray<Pair> array;
  std::size_t wrong = 0;
  for (std::uint64_t i = 0; i < 500000; ++i) {  // 8 MB: several huge pages
    array.grow_to(i + 1);
    wrong += array[i].a != 0 || array[i].b != 0;
    array[i] = {i, ~i};
  }
  ASSERT_EQ(array.size(), 500000u);
  for (std::uint64_t i = 0; i < array.size(); ++i) wrong += array[i].a != i || array[i].b != ~i;
  EXPECT_EQ(wrong, 0u);
}

TEST(PageArray, TakesALeapOverManyPages) {
  PageArray<std::uint8_t> array;
  array.grow_to(3);
  array[2] = 7;
  array.grow_to(100000000);
  EXPECT_EQ(array[2], 7);
  EXPECT_EQ(array[99999999], 0);
  array[99999999] = 9;
  EXPECT_EQ(array[99999999], 9);
}

TEST(PageArray, NeverShrinksButForgetsAllOnClear) {
  PageArray<int> array;
  array.grow_to(100);
  array.grow_to(10);
  EXPECT_EQ(array.size(), 100u);
  array[5] = 42;
  array.clear();
  EXPECT_EQ(array.size(), 0u);
  array.grow_to(6);
  EXPECT_EQ(array.size(), 6u);
  EXPECT_EQ(array[5], 42);  // what grows again starts with what was there
}

TEST(PageArray, StartsAfreshWhenItHasGivenItsPagesBack) {
  PageArray<int> array;
  array.free();
  array.grow_to(10);
  array[5] = 42;
  array.free();
  EXPECT_EQ(array.size(), 0u);
  array.grow_to(10);
  EXPECT_EQ(array[5], 0);
}

}  // namespace
}  // namespace delvox
