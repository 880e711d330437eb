#include <gtest/gtest.h>

#include <sstream>

#include "config_json.h"
#include "delvox/core/errors.h"
#include "format.h"
#include "patient_frame.h"
#include "progress.h"
#include "text_histogram.h"

namespace delvox::tools {
namespace {

TEST(Format, GroupsThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1,000");
  EXPECT_EQ(grouped(1234567), "1,234,567");
}

TEST(Format, ANumberIsAllOfItsText) {
  EXPECT_EQ(parse_number("-2.5e1", "--iso"), -25);
  EXPECT_EQ(parse_number("+3", "--iso"), 3);
  for (const char* text : {"", "3mm", "nan", "inf", "1e999", "--3"}) {
    EXPECT_THROW(parse_number(text, "--iso"), OptionError) << text;
  }
}

TEST(ConfigJson, TakesStringsNumbersBooleansAndArrays) {
  std::istringstream input(R"({"size": 2.5, "below": true, "output": ["a.vtu", "b.stl"], "iso": "otsu"})");
  const auto items = ConfigJson().from_config(input);
  ASSERT_EQ(items.size(), 4u);
  EXPECT_EQ(items[0].name, "below");
  EXPECT_EQ(items[0].inputs, std::vector<std::string>{"true"});
  EXPECT_EQ(items[2].inputs, (std::vector<std::string>{"a.vtu", "b.stl"}));
  EXPECT_EQ(items[3].inputs, std::vector<std::string>{"2.5"});
}

TEST(FrameChange, TurnsTheWorldPointsOfFlags) {
  const FrameChange same(Frame::kRas, "ras"), turned(Frame::kRas, "lps"), unknown(Frame::kUnknown, "lps");
  EXPECT_EQ(same.iso_in_volume("at:1,2,3"), "at:1,2,3");
  EXPECT_EQ(turned.iso_in_volume("at:1,-2,3"), "at:-1,2,3");
  EXPECT_EQ(turned.iso_in_volume("p97.5"), "p97.5");
  EXPECT_EQ(turned.crop_in_volume("1:5,-3:,2:4mm"), "-5:-1,:3,2:4mm");
  EXPECT_EQ(turned.crop_in_volume("1:5,3:,2:4"), "1:5,3:,2:4");
  EXPECT_EQ(unknown.target(), Frame::kLps);
  EXPECT_FALSE(unknown.turns());
}

TEST(ProgressPace, TellsEachStageOnceAndElseEveryInterval) {
  using std::chrono::seconds;
  ProgressPace pace(seconds(10));
  const ProgressPace::Clock::time_point start = ProgressPace::Clock::now();
  std::size_t lines = 0;
  for (int n = 0; n < 600; ++n) {  // a minute of turns, ten a second
    lines += pace.due(n % 2 == 0 ? "surface" : "topology", start + n * std::chrono::milliseconds(100));
  }
  EXPECT_GE(lines, 2u + 5);
  EXPECT_LE(lines, 2u + 6);
  EXPECT_TRUE(pace.due("tets", start + seconds(60)));
  EXPECT_FALSE(pace.due("tets", start + seconds(61)));
}

TEST(TextHistogram, ShowsEveryOccupiedBinAndTheMarks) {
  const std::string text = text_histogram({0, 4, {1000, 0, 1, 10}}, {2.5});
  EXPECT_NE(text.find("--^-"), std::string::npos) << text;
  EXPECT_NE(text.find("█ ▆"), std::string::npos) << text;
}

}  // namespace
}  // namespace delvox::tools
