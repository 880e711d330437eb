// The forecast and --max-memory of the real program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

class CliForecast : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome made = run_delvox({"phantom", "sphere", "-o", volume(), "--quiet"});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  std::string volume() const { return folder_ / "sphere.nii"; }

  Outcome mesh(const std::string& verb, std::vector<std::string> more) const {
    more.insert(more.begin(), {verb, volume(), "-o", folder_ / "mesh.vtu"});
    return run_delvox(more);
  }

  // What the pattern's group matches in the text.
  static std::string found(const std::string& text, const char* pattern) {
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern))) << text;
    return match.empty() ? "" : match[1].str();
  }

  // Refused just above a memory that leaves `share` of what the mesh needs; then the size that was named fits.
  void expect_named_size_fits(const std::string& verb, const std::string& size, double least_mb) {
    const std::vector<std::string> before = folder_.names();
    const Outcome small = mesh(verb, {"--size", size, "--max-memory", "1M"});
    EXPECT_EQ(small.code, 5) << small.err;
    EXPECT_NE(small.err.find("no size would fit"), std::string::npos) << small.err;
    const double all_mb = std::stod(found(small.err, "forecast of ([0-9.]+) MB"));
    ASSERT_GT(all_mb, least_mb);
    const std::string limit = std::to_string(all_mb - 0.6 * least_mb) + "M";
    const Outcome refused = mesh(verb, {"--size", size, "--max-memory", limit, "--quiet"});
    EXPECT_EQ(refused.code, 5) << refused.err;
    EXPECT_EQ(line_count(refused.err), 1u) << refused.err;
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(folder_.names(), before);
    const std::string fitting = found(refused.err, "--size ([0-9.]+) would fit");
    const Outcome done = mesh(verb, {"--size", fitting, "--max-memory", limit});
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_GT(std::stod(fitting), std::stod(size));
    EXPECT_LT(std::stod(fitting), 4 * std::stod(size));
  }

  TemporaryFolder folder_;
};

TEST_F(CliForecast, IsOneLineBeforeMeshingAndInTheReport) {
  const Outcome tet = mesh("tet", {"--size", "2", "--report", folder_ / "report.json"});
  EXPECT_EQ(tet.code, 0) << tet.err;
  found(tet.err, "\nforecast: about ([0-9,]+) vertices, [0-9,]+ tets; [0-9.]+ s, [0-9.]+ MB of memory in all\n");
  const auto report = nlohmann::json::parse(read_file(folder_ / "report.json"));
  const double tets = report["check"]["statistics"]["tets"].get<double>();
  EXPECT_NEAR(report["forecast"]["likely"]["tets"].get<double>(), tets, 0.25 * tets);
  EXPECT_GT(report["peak_bytes"].get<double>(), 0);
  EXPECT_NE(mesh("surface", {}).err.find(" triangles; "), std::string::npos);
  EXPECT_EQ(mesh("tet", {"--quiet"}).err, "");
  const std::string searching = mesh("tet", {"--tets", "3000"}).err;
  EXPECT_EQ(searching.find("forecast"), searching.rfind("forecast")) << "once for all runs of --tets";
}

TEST_F(CliForecast, MoreThanTheMemoryAllowedIsRefusedWithASizeThatFits) {
  expect_named_size_fits("tet", "0.5", 100);
  expect_named_size_fits("surface", "0.3", 30);
}

TEST_F(CliForecast, EveryKindOfSizeGetsItsAdvice) {
  const std::string little = "120M";
  const Outcome both = mesh("tet", {"--size", "0.4", "--cell-size", "0.5", "--max-memory", little});
  EXPECT_EQ(both.code, 5) << both.err;
  EXPECT_GT(std::stod(found(both.err, "--size [0-9.]+ with --cell-size ([0-9.]+) would fit")), 0.5);
  const Outcome searched = mesh("tet", {"--tets", "3000000", "--max-memory", little});
  EXPECT_EQ(searched.code, 5) << searched.err;
  EXPECT_NE(searched.err.find(" in place of --tets would fit, with about "), std::string::npos) << searched.err;
  const Outcome limited = mesh("tet", {"--size", "0.1", "--max-memory", "1G", "--max-vertices", "2000"});
  EXPECT_NE(limited.err.find("wrote"), std::string::npos) << "not refused, since it stops before: " << limited.err;
}

TEST_F(CliForecast, AMemoryThatIsNoneIsAUsageErrorBeforeAnyWork) {
  for (const char* text : {"lots", "0", "-4G"}) {
    const Outcome outcome = run_delvox({"tet", "not_read_yet.nii", "-o", folder_ / "m.vtu", "--max-memory", text});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
  }
}

TEST_F(CliForecast, SizesTooSmallForAnyNumberAreRefused) {
  EXPECT_EQ(mesh("tet", {"--cell-size", "1e-300", "--max-memory", "1G", "--quiet"}).code, 5);
  EXPECT_EQ(mesh("tet", {"--size", "1e-9", "--max-memory", "1G", "--quiet"}).code, 5);
}

}  // namespace
}  // namespace delvox::test
