// --threads changes how fast, never what.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

using nlohmann::json;

constexpr const char* kThreads[] = {"1", "2", "4"};

class CliThreads : public ::testing::Test {
 protected:
  void SetUp() override {
    volume_ = folder_ / "v.nii";
    const Outcome outcome = run_delvox({"phantom", "noisy-sphere", "-o", volume_, "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  void run(const std::vector<std::string>& arguments) {
    const Outcome outcome = run_delvox(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  TemporaryFolder folder_;
  std::string volume_;
};

TEST_F(CliThreads, EveryFormatGetsTheSameBytes) {
  const std::vector<std::string> extensions{".vtu", ".vtk",  ".stl", ".ply",  ".off",
                                            ".obj", ".mesh", ".msh", ".msh2", ".inp"};
  for (const char* threads : kThreads) {
    std::vector<std::string> arguments{"tet", volume_, "--smooth", "1", "--size", "2", "--threads", threads, "--quiet"};
    for (const std::string& extension : extensions) {
      arguments.insert(arguments.end(), {"-o", folder_ / (threads + extension)});
    }
    run(arguments);
  }
  for (const std::string& extension : extensions) {
    const std::string one = read_file(folder_ / ("1" + extension));
    EXPECT_FALSE(one.empty());
    for (const char* threads : kThreads)
      EXPECT_TRUE(one == read_file(folder_ / (threads + extension))) << threads << extension;
  }
}

TEST_F(CliThreads, CheckFindsTheSameToTheLastDigit) {
  const std::string mesh = folder_ / "a.vtu";
  run({"tet", volume_, "--smooth", "1", "--size", "2", "-o", mesh, "--quiet"});
  json first;
  for (const char* threads : kThreads) {
    const Outcome outcome =
        run_delvox({"check", mesh, "--volume", volume_, "--smooth", "1", "--json", "--threads", threads});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const json report = json::parse(outcome.out);
    EXPECT_EQ(report["threads"], std::stoi(threads));
    if (first.is_null()) first = report["meshes"];
    EXPECT_EQ(report["meshes"].dump(), first.dump()) << threads;
  }
}

TEST_F(CliThreads, AConfigFileMaySetThemAndNoneIsRefused) {
  const std::string config = folder_ / "c.json";
  write_file(config, R"({"threads": 1})");
  const Outcome outcome =
      run_delvox({"tet", volume_, "--smooth", "1", "-o", folder_ / "a.vtu", "--config", config, "--json"});
  EXPECT_EQ(json::parse(outcome.out)["threads"], 1);
  EXPECT_EQ(run_delvox({"info", volume_, "--threads", "0", "--quiet"}).code, 2);
}

}  // namespace
}  // namespace delvox::test
