// The book's variants on the command line: sizes of the surface's own, DelSurf1, persistent triangles, Del|Sigma.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "delvox/mesh_io/write_mesh.h"
#include "support/test_meshes.h"
#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

using nlohmann::json;
const std::string kBox = "--box=-2:2,-2:2,-2:2";
const std::string kTorus = "(sqrt(x^2+y^2)-1)^2+z^2-0.25";

class CliVariants : public ::testing::Test {
 protected:
  Outcome run(const std::vector<std::string>& arguments) { return run_delvox(arguments, {.folder = folder_.path()}); }

  void expect_usage_error(std::vector<std::string> arguments, const std::vector<std::string>& words) {
    const auto before = folder_.names();
    arguments.insert(arguments.end(), {"-o", "out.ply", "--quiet"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(folder_.names(), before);
  }

  TemporaryFolder folder_;
};

TEST_F(CliVariants, EveryVariantMakesATorusTheSameForAnyNumberOfThreads) {
  for (const std::string verb : {"surface", "tet"}) {
    std::string first;
    for (const std::string start : {"seeds", "persistent"}) {
      for (const std::string restricted : {"bipolar", "all"}) {
        const std::string name = verb + start + restricted;
        for (const std::string threads : {"1", "2"}) {
          const Outcome outcome = run({verb, "--implicit", kTorus, kBox, "--start", start, "--restricted", restricted,
                                       "--threads", threads, "-o", name + threads + ".vtu"});
          EXPECT_EQ(outcome.code, 0) << outcome.err;
          EXPECT_NE(outcome.out.find("genus 1"), std::string::npos) << outcome.out;
        }
        EXPECT_TRUE(read_file(folder_ / (name + "1.vtu")) == read_file(folder_ / (name + "2.vtu"))) << name;
        EXPECT_EQ(run({"check", name + "1.vtu"}).code, 0);
      }
    }
  }
}

TEST_F(CliVariants, SurfaceOnlyAfterDenseTellsWhatWasInsertedWhereAndMakesTheSameForAnyNumberOfThreads) {
  for (const std::string threads : {"1", "2", "4"}) {
    const Outcome outcome = run({"surface", "--implicit", kTorus, kBox, "--surface-only-after-dense", "--threads", threads,
                                 "--report", "report.json", "-o", threads + ".ply"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("genus 1"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.err.find("on the surface alone"), std::string::npos) << outcome.err;
    const json report = json::parse(read_file(folder_ / "report.json"));
    EXPECT_EQ(report["options"]["surface-only-after-dense"], true);
    EXPECT_GT(report["run"]["dense_insertions"], 0);
    EXPECT_EQ(report["run"]["dense_failures"], 0);
    EXPECT_TRUE(read_file(folder_ / (threads + ".ply")) == read_file(folder_ / "1.ply"));
  }
  EXPECT_EQ(run({"check", "1.ply"}).code, 0);
  const Outcome remeshed = run({"remesh", "1.ply", "--size", "0.05", "--surface-only-after-dense", "-o", "2.stl"});
  EXPECT_EQ(remeshed.code, 0) << remeshed.err;
  EXPECT_NE(remeshed.out.find("genus 1"), std::string::npos) << remeshed.out;
}

TEST_F(CliVariants, SurfaceOnlyAfterDenseIsRefusedWhereSpaceIsNeeded) {
  const std::string flag = "--surface-only-after-dense";
  expect_usage_error({"tet", "--implicit", kTorus, kBox, flag}, {flag, "tets", "delvox surface"});
  expect_usage_error({"surface", "--implicit", kTorus, kBox, flag, "--algorithm", "delsurf1"}, {flag, "delsurf1"});
  expect_usage_error({"surface", "--implicit", kTorus, kBox, flag, "--algorithm", "delsurf2"}, {flag, "delsurf2"});
  expect_usage_error({"surface", "--implicit", kTorus, kBox, flag, "--start", "persistent"}, {flag, "persistent"});
  expect_usage_error({"surface", "--implicit", kTorus, kBox, flag, "--restricted", "all"}, {flag, "restricted"});
  expect_usage_error({"surface", "--implicit", kTorus, kBox, flag, "--max-roughness", "30"}, {flag, "roughness"});
  expect_usage_error({"remesh", "a.off", flag, "--feature-angle", "60"}, {flag, "--feature-angle"});
}

TEST_F(CliVariants, TheSeedChoosesThePersistentTriangle) {
  for (const std::string seed : {"0", "1"}) {
    EXPECT_EQ(
        run({"surface", "--implicit", kTorus, kBox, "--start", "persistent", "--seed", seed, "-o", seed + ".ply"}).code,
        0);
  }
  EXPECT_EQ(run({"surface", "--implicit", kTorus, kBox, "--start", "persistent", "-o", "default.ply"}).code, 0);
  EXPECT_TRUE(read_file(folder_ / "0.ply") == read_file(folder_ / "default.ply"));
  EXPECT_FALSE(read_file(folder_ / "0.ply") == read_file(folder_ / "1.ply"));
}

TEST_F(CliVariants, DelSurf1TakesTheLocalFeatureSizeAndSaysSo) {
  const Outcome outcome =
      run({"surface", "--implicit", kTorus, kBox, "--algorithm", "delsurf1", "-o", "a.vtu", "--report", "a.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("size 0.08 * lfs, "), std::string::npos) << outcome.err;
  const json report = json::parse(read_file(folder_ / "a.json"));
  EXPECT_EQ(report["check"]["statistics"]["euler"], 0);
  EXPECT_GT(report["check"]["statistics"]["points"], 5000);
  EXPECT_EQ(run({"check", "a.vtu"}).code, 0);
}

// It looks at nothing but sizes: what comes of those that are too large is for the check to find.
TEST_F(CliVariants, DelSurf1WithSizesTooLargeIsNoManifoldAndFails) {
  const std::string gyroid = "max(sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x), x^2+y^2+z^2-3)";
  const Outcome outcome = run(
      {"surface", "--implicit", gyroid, kBox, "--size", "0.5", "--algorithm", "delsurf1", "-o", "a.ply", "--quiet"});
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_NE(outcome.err.find("manifold"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"surface", "--implicit", gyroid, kBox, "--size", "0.5", "-o", "b.ply"}).code, 0);
}

TEST_F(CliVariants, SizesByFormulaCurvatureAndFeatureSizeAreKept) {
  const auto triangles = [&](const std::string& verb, const std::vector<std::string>& size) {
    std::vector<std::string> arguments{verb, "--implicit", kTorus, kBox, "-o", "a.vtu", "--json"};
    arguments.insert(arguments.end(), size.begin(), size.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out)["check"]["statistics"]["triangles"].get<double>();
  };
  const double coarse = triangles("surface", {"--size", "0.2"});
  EXPECT_NEAR(triangles("surface", {"--size", "0.1+0.1"}), coarse, 0.1 * coarse);
  EXPECT_GT(triangles("surface", {"--size", "0.05+0.075*(z+0.5)"}), 2 * coarse);
  // Its least radius of curvature, as its feature size, is 0.5.
  EXPECT_NEAR(triangles("surface", {"--size", "curvature", "--epsilon", "0.4"}), coarse, 0.2 * coarse);
  EXPECT_NEAR(triangles("surface", {"--size", "lfs", "--epsilon", "0.4"}), coarse, 0.2 * coarse);
  EXPECT_NEAR(triangles("tet", {"--size", "lfs", "--epsilon", "0.4"}), coarse, 0.2 * coarse);
}

TEST_F(CliVariants, FeatureSizesAreThereForVolumesAndPolygonsToo) {
  EXPECT_EQ(run({"phantom", "torus", "-o", "torus.nii", "--quiet"}).code, 0);
  for (const std::string size : {"lfs", "curvature"}) {
    const Outcome outcome =
        run({"surface", "torus.nii", "--iso", "0.5", "--size", size, "--epsilon", "0.5", "-o", "a.ply"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  write_mesh(icosphere(4, 10), folder_ / "sphere.stl");
  const Outcome outcome = run({"remesh", "sphere.stl", "--size", "lfs", "--epsilon", "0.2", "-o", "b.ply"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expect_usage_error({"remesh", "sphere.stl", "--size", "curvature"}, {"--size curvature", "polygon"});
}

TEST_F(CliVariants, WhatMakesNoSenseIsAUsageError) {
  const std::vector<std::string> surface{"surface", "--implicit", kTorus, kBox};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = surface;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_usage_error(with({"--start", "middle"}), {"--start"});
  expect_usage_error(with({"--seed", "3"}), {"--seed", "--start"});
  expect_usage_error(with({"--restricted", "some"}), {"--restricted"});
  expect_usage_error(with({"--algorithm", "delsurf3"}), {"--algorithm"});
  expect_usage_error(with({"--epsilon", "0.1"}), {"--epsilon"});
  expect_usage_error(with({"--epsilon", "0.1", "--size", "0.1"}), {"--epsilon"});
  for (const std::string epsilon : {"0", "-1", "1.5", "x"}) {
    expect_usage_error(with({"--size", "lfs", "--epsilon", epsilon}), {"--epsilon"});
  }
  expect_usage_error(with({"--size", "0.1+"}), {"--size", "nor a formula", "position"});
  expect_usage_error(with({"--size", "sizes.nii"}), {"--size", "sizes.nii", "volume file"});
  expect_usage_error(with({"--size", "0.1*x"}), {"--size", "positive"});
  expect_usage_error({"tet", "--implicit", kTorus, kBox, "--algorithm=delsurf1"}, {"--algorithm"});
  expect_usage_error({"remesh", "sphere.stl", "--algorithm=delsurf2"}, {"--algorithm", "delsurf1"});
}

}  // namespace
}  // namespace delvox::test
