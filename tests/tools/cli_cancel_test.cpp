// Stopping the real program: signals and limits.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

std::string make_sphere(const TemporaryFolder& folder) {
  const std::string path = folder / "sphere.nii";
  EXPECT_EQ(run_delvox({"phantom", "sphere", "-o", path, "--quiet"}).code, 0);
  return path;
}

/// Runs a mesher, sends it the signals on its way, and expects a cancelled run that says so and leaves nothing.
void expect_cancelled(const std::vector<int>& signals, const std::string& by) {
  TemporaryFolder in, out;
  const std::string volume = make_sphere(in);
  const Outcome outcome = run_delvox({"tet", volume, "--size", "0.4", "-o", out / "mesh.vtu", "-o", out / "mesh.stl"},
                                     {.signals = signals, .signal_after = "surface"});
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("cancelled by " + by), std::string::npos) << outcome.err;
  EXPECT_TRUE(out.names().empty());
}

TEST(CliCancel, ASignalWhileMeshingExitsWith130SaysWhoSentItAndLeavesNothing) {
  const std::string us = " from process " + std::to_string(::getpid());
  expect_cancelled({SIGINT}, "SIGINT" + us);
  expect_cancelled({SIGTERM}, "SIGTERM" + us);
}

// As timeout(1) does, which signals its child and then the group.
TEST(CliCancel, TwoSignalsAtOnceAreOneRequest) {
  expect_cancelled({SIGTERM, SIGINT, SIGHUP}, "");
}

TEST(CliCancel, ALimitExitsWith5AndWritesAMarkedMesh) {
  TemporaryFolder folder;
  const std::string volume = make_sphere(folder);
  const std::string mesh = folder / "mesh.vtu", report = folder / "report.json";
  const Outcome outcome = run_delvox(
      {"tet", volume, "--size", "2", "--max-vertices", "500", "-o", mesh, "--report", report, "--quiet"});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("--max-vertices"), std::string::npos) << outcome.err;
  EXPECT_EQ(run_delvox({"check", mesh, "--quiet"}).code, 5);
  const auto json = nlohmann::json::parse(read_file(report));
  EXPECT_FALSE(json["mesh"]["complete"].get<bool>());
  EXPECT_EQ(json["run"]["stop"], "max-vertices reached");
}

TEST(CliCancel, MaxSecondsBoundsTheSearchForANumberOfTets) {
  TemporaryFolder folder;
  const std::string volume = make_sphere(folder);
  const Outcome outcome = run_delvox(
      {"tet", volume, "--tets", "3000000", "--max-seconds", "0.5", "-o", folder / "mesh.vtu", "--quiet"});
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_NE(outcome.err.find("--max-seconds"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace delvox::test
