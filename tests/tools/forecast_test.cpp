#include "forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/core/errors.h"
#include "format.h"

namespace delvox::tools {
namespace {

constexpr double kMega = 1024 * 1024;

// A run whose vertices go with factor^-3 down to a floor.
ProcessForecast forecast_at(double factor, double floor_bytes) {
  Estimate estimate;
  estimate.vertices = 1e6 / (factor * factor * factor);
  estimate.bytes = floor_bytes + 400 * estimate.vertices;
  return {{estimate, estimate}, {50 * kMega, 60 * kMega}};
}

TEST(Memory, IsReadInPowersOf1024) {
  EXPECT_EQ(parse_memory("4G", "--max-memory"), 4096 * kMega);
  EXPECT_EQ(parse_memory("800m", "--max-memory"), 800 * kMega);
  EXPECT_EQ(parse_memory("1.5GB", "--max-memory"), 1536 * kMega);
  EXPECT_EQ(parse_memory("2048", "--max-memory"), 2048);
  for (const char* text : {"", "G", "0", "0M", "-1G", "4X", "four", "4 G", "1e9", "4GG", "nan", "\n"}) {
    EXPECT_THROW(parse_memory(text, "--max-memory"), OptionError) << text;
  }
}

TEST(Memory, IsToldInThreeDigits) {
  EXPECT_EQ(memory_text(1536 * kMega), "1.5 GB");
  EXPECT_EQ(memory_text(97.64 * kMega), "97.6 MB");
  EXPECT_EQ(memory_text(2048), "2 KB");
}

TEST(Memory, OfTheProcessIsKnown) {
  const ProcessMemory memory = process_memory();
  EXPECT_GT(memory.now, kMega);
  EXPECT_GE(memory.peak, memory.now);
}

TEST(RoundedUp, HasThreeDigitsAndIsNeverLess) {
  EXPECT_EQ(rounded_up(1.68), "1.68");
  EXPECT_EQ(rounded_up(1.6801), "1.69");
  EXPECT_EQ(rounded_up(0.099999), "0.1");
  EXPECT_EQ(rounded_up(1234), "1240");
  EXPECT_EQ(rounded_up(123.4), "124");
}

TEST(FactorThatFits, IsTheLeastToAPercentThatLeavesSomeToSpare) {
  const auto at = [](double factor) { return forecast_at(factor, 0); };
  const double limit = 150 * kMega;
  const auto factor = factor_that_fits(at, limit);
  ASSERT_TRUE(factor);
  EXPECT_LT(at(*factor).peak_bytes(), limit);
  EXPECT_GT(at(*factor * 0.95).peak_bytes(), 0.97 * limit);
}

TEST(FactorThatFits, IsNoneWhereNoSizeHelps) {
  EXPECT_FALSE(factor_that_fits([](double f) { return forecast_at(f, 0); }, 55 * kMega));  // the peak so far
  EXPECT_FALSE(factor_that_fits([](double f) { return forecast_at(f, 1000 * kMega); }, 500 * kMega));    // the floor
  EXPECT_FALSE(factor_that_fits([](double f) { return forecast_at(f, 13.52 * kMega); }, 65.5 * kMega));  // no mesh left
}

TEST(Limited, TakesTheShareOfTheVertices) {
  const Forecast whole = forecast_at(1, 0).mesh;
  EXPECT_EQ(limited(whole, 0).likely.vertices, whole.likely.vertices);
  EXPECT_EQ(limited(whole, 2'000'000).likely.bytes, whole.likely.bytes);
  EXPECT_NEAR(limited(whole, 100'000).likely.vertices, 100'000, 1e-6);
  EXPECT_NEAR(limited(whole, 100'000).likely.bytes, 0.1 * whole.likely.bytes, 1);
}

TEST(Forecast, IsOneLineThatSaysAtLeastWherePartsAreThin) {
  Estimate least{1234, 800, 5678, 0.25, 10 * kMega}, likely{41234, 80000, 133000, 12.3, 100 * kMega};
  EXPECT_EQ(describe({{least, least}, {20 * kMega, 20 * kMega}}),
            "forecast: about 1,200 vertices, 5,700 tets; 0.25 s, 30 MB of memory in all");
  EXPECT_EQ(describe({{least, likely}, {20 * kMega, 20 * kMega}}),
            "forecast: at least 1,200 vertices, 5,700 tets, about 41,000 vertices, 130,000 tets if parts thinner than "
            "the size are resolved; 12 s, 120 MB of memory in all");
  likely.seconds = 4321;
  EXPECT_NE(describe({{likely, likely}, {}}).find("; 4,300 s, 100 MB"), std::string::npos);
  least.tets = 0;
  EXPECT_EQ(elements({least, least}), "about 1,200 vertices, 800 triangles");
}

}  // namespace
}  // namespace delvox::tools
