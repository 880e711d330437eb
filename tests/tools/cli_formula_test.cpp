// Formulas on the command line.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

using nlohmann::json;
const std::string kBox = "--box=-2:2,-2:2,-2:2";

Outcome run_on(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  return run_delvox(arguments, {.folder = folder.path()});
}

TEST(CliFormula, ATorusBecomesASurfaceAndTets) {
  const TemporaryFolder folder;
  const std::string torus = "(sqrt(x^2+y^2)-1)^2+z^2-0.1";
  const Outcome surface = run_on(folder, {"surface", "--implicit", torus, kBox, "-o", "torus.ply"});
  EXPECT_EQ(surface.code, 0) << surface.err;
  EXPECT_NE(surface.out.find("genus 1"), std::string::npos) << surface.out;
  EXPECT_NE(surface.err.find("size 0.1732 mm, 1/40 of the box's diagonal"), std::string::npos) << surface.err;
  EXPECT_NE(surface.err.find("forecast: about"), std::string::npos) << surface.err;

  const Outcome tet = run_on(folder, {"tet", "--implicit", torus, kBox, "-o", "torus.vtu", "--report", "torus.json"});
  EXPECT_EQ(tet.code, 0) << tet.err;
  const json report = json::parse(read_file(folder / "torus.json"));
  EXPECT_EQ(report["formula"], torus);
  EXPECT_EQ(report["box"]["max"], json({2, 2, 2}));
  EXPECT_EQ(run_on(folder, {"check", "torus.vtu"}).code, 0);
  EXPECT_EQ(run_on(folder, {"check", "torus.ply", "torus.vtu", "--implicit", torus, kBox, "--same-topology"}).code, 0);
  const Outcome beside = run_on(folder, {"check", "torus.ply", "--quiet", "--implicit", torus, "--box=5:6,5:6,5:6"});
  EXPECT_EQ(beside.code, 2);
  EXPECT_NE(beside.err.find("does not hold all of torus.ply"), std::string::npos) << beside.err;
  const Outcome thinner = run_on(folder, {"check", "torus.ply", "--quiet", "--implicit", torus + "+0.01", kBox});
  EXPECT_EQ(thinner.code, 5);
  EXPECT_NE(thinner.err.find("nodes on the surface of the function"), std::string::npos) << thinner.err;
}

TEST(CliFormula, CheckComparesWithOneThingAtATime) {
  const std::vector<std::string> sphere = {"check", "a.ply", "--implicit", "x^2+y^2+z^2-1", kBox};
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--volume", "a.nii"}, {"--surface", "a.stl"},
                                               {"--interpolation", "quintic"}, {"--smooth", "1"}, {"--largest"}}) {
    std::vector<std::string> all = sphere;
    all.insert(all.end(), more.begin(), more.end());
    EXPECT_EQ(run_delvox(all).code, 2) << more[0];
  }
}

TEST(CliFormula, TheNumberOfTetsCanBeAskedFor) {
  const TemporaryFolder folder;
  const Outcome outcome = run_on(
      folder, {"tet", "--implicit", "x^2+2*y^2+z^2-1", kBox, "--tets", "5000", "-o", "a.vtu", "--report", "a.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("for 5,000 tets"), std::string::npos) << outcome.err;
}

TEST(CliFormula, EdgesOfMaxAreMeshedAsTheyCome) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_on(folder, {"surface", "--implicit", "max(abs(x),abs(y),abs(z))-1", kBox, "--size", "0.1", "-o", "cube.stl"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("Euler number 2,"), std::string::npos) << outcome.out;
}

TEST(CliFormula, RoughnessIsBoundedPromisedAndCheckedOrToldWhereItCannotBeHad) {
  const TemporaryFolder folder;
  const std::string torus = "(sqrt(x^2+y^2)-1)^2+z^2-0.1";
  for (const std::string threads : {"1", "2"}) {
    const Outcome surface = run_on(folder, {"surface", "--implicit", torus, kBox, "--max-roughness", "10", "--threads",
                                            threads, "-o", threads + ".vtu", "--json"});
    EXPECT_EQ(surface.code, 0) << surface.err;
    EXPECT_EQ(json::parse(surface.out)["mesh"]["promises"]["max_roughness_degrees"], 10);
  }
  EXPECT_TRUE(read_file(folder / "1.vtu") == read_file(folder / "2.vtu"));
  const Outcome check = run_on(folder, {"check", "1.vtu", "--json"});
  EXPECT_EQ(check.code, 0) << check.err;
  for (const json& one : json::parse(check.out)["meshes"][0]["checks"]) {  // held to what the file carries
    if (one["name"] != "roughness") continue;
    EXPECT_EQ(one["status"], "passed");
    EXPECT_EQ(one["bound"], 10);
  }
  EXPECT_EQ(run_on(folder, {"check", "1.vtu", "--max-roughness", "10"}).code, 0);
  const Outcome smoother = run_on(folder, {"check", "1.vtu", "--max-roughness", "5", "--quiet"});
  EXPECT_EQ(smoother.code, 5);
  EXPECT_NE(smoother.err.find("roughness"), std::string::npos) << smoother.err;

  const Outcome cube = run_on(folder, {"tet", "--implicit", "max(abs(x),abs(y),abs(z))-1", kBox, "--size", "0.3",
                                       "--max-roughness", "30", "-o", "cube.vtu", "--json"});
  EXPECT_EQ(cube.code, 0) << cube.err;
  const json report = json::parse(cube.out);
  EXPECT_TRUE(report["mesh"]["promises"]["max_roughness_degrees"].is_null());
  EXPECT_NE(report["run"]["unmet"].dump().find("roughness"), std::string::npos);
}

// The library that derives formulas orders terms by addresses, which differ from run to run.
TEST(CliFormula, RunsGiveTheSameBytes) {
  const TemporaryFolder folder;
  const std::string formula =
      "sin(3*x)*cos(2*y)*0.3+(x-y+z*0.7)^2+x^2*0.9+y^2*1.1+0.3*z^2-x*y*z*0.1+cos(x-z)/(2+y^2)-1.2";
  std::string first;
  for (int run = 0; run < 4; ++run) {
    const Outcome outcome = run_on(folder, {"tet", "--implicit", formula, kBox, "-o", "out.vtu", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string bytes = read_file(folder / "out.vtu");
    if (run == 0) first = bytes;
    EXPECT_TRUE(bytes == first) << "run " << run;
  }
}

TEST(CliFormula, WhatMakesNoSenseIsAUsageError) {
  const TemporaryFolder folder;
  const auto expect_usage_error = [&](std::vector<std::string> arguments, const std::vector<std::string>& words) {
    arguments.insert(arguments.end(), {"-o", "out.ply", "--quiet"});
    const Outcome outcome = run_on(folder, arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_TRUE(folder.names().empty());
  };
  expect_usage_error({"surface", "--implicit", "x^2+", kBox}, {"position 5"});
  expect_usage_error({"surface", "--implicit", "x^2+y^2+z^2-1"}, {"--box"});
  expect_usage_error({"surface", kBox}, {"--implicit"});
  expect_usage_error({"surface"}, {"VOLUME", "--implicit"});
  expect_usage_error({"surface", "--implicit", "x^2+y^2+z^2-9", kBox}, {"border of the box", "widen"});
  for (const std::string degrees : {"0", "-3", "181", "nan", "x"}) {
    expect_usage_error({"surface", "--implicit", "x^2+y^2+z^2-1", kBox, "--max-roughness", degrees},
                       {"--max-roughness"});
  }
  for (const std::string box : {"0:1,0:1", "0:1,0:1,1:0", "0:1,0:1,0", "0:1,0:1,0:nan", "a:b,0:1,0:1"}) {
    expect_usage_error({"surface", "--implicit", "x-0.5", "--box=" + box}, {"--box", box});
  }
  const std::vector<std::vector<std::string>> of_volumes = {{"--iso", "3"},
                                                            {"--below"},
                                                            {"--crop", "0:3,0:3,0:3"},
                                                            {"--resample", "1"},
                                                            {"--smooth", "1"},
                                                            {"--largest"},
                                                            {"--min-component", "1"},
                                                            {"--fill-cavities"},
                                                            {"--border", "open"},
                                                            {"--spacing", "1,1,1"},
                                                            {"--volume-index", "1"},
                                                            {"scan.nii"}};
  for (const auto& flag : of_volumes) {
    std::vector<std::string> arguments = {"surface", "--implicit", "x^2+y^2+z^2-1", kBox};
    arguments.insert(arguments.end(), flag.begin(), flag.end());
    expect_usage_error(arguments, {"--implicit", "excludes"});
  }
}

TEST(CliFormula, DelSurf2TakesNoSize) {
  const TemporaryFolder folder;
  const Outcome outcome = run_on(folder, {"surface", "--implicit", "(sqrt(x^2+y^2)-1)^2+z^2-0.1", kBox, "--algorithm",
                                          "delsurf2", "-o", "torus.ply", "--report", "torus.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("genus 1"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("no size: as fine as the topology asks"), std::string::npos) << outcome.out;
  const json report = json::parse(read_file(folder / "torus.json"));
  EXPECT_EQ(report["options"]["algorithm"], "delsurf2");
  EXPECT_LT(report["check"]["statistics"]["points"], 200);
  EXPECT_EQ(run_on(folder, {"check", "torus.ply"}).code, 0);

  const Outcome fine = run_on(folder, {"surface", "--implicit", "x^2+y^2+z^2-1", kBox, "--algorithm", "delsurf2",
                                       "--size", "0.1", "-o", "fine.vtk", "--report", "fine.json"});
  EXPECT_EQ(fine.code, 0) << fine.err;
  EXPECT_GT(json::parse(read_file(folder / "fine.json"))["check"]["statistics"]["points"], 400);
}

TEST(CliFormula, ARunOfDelSurf2ThatALimitStopsSaysSo) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_on(folder, {"surface", "--implicit", "(sqrt(x^2+y^2)-1)^2+z^2-0.1", kBox, "--algorithm", "delsurf2",
                      "--max-vertices", "20", "-o", "torus.ply", "--quiet"});
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("max-vertices"), std::string::npos) << outcome.err;
}

TEST(CliFormula, DelSurf2RefusesWhatIsNotSmooth) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::vector<std::string>& arguments, const std::string& words) {
    std::vector<std::string> all = {"surface", "--algorithm", "delsurf2", "-o", "out.ply", "--quiet"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run_on(folder, all);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_TRUE(folder.names().empty());
  };
  refuse({"--implicit", "max(abs(x),abs(y),abs(z))-1", kBox}, "near 1, 1, 1 it may meet a kink");
  refuse({"--implicit", "sqrt(x^2+y^2)+z^2-1", kBox}, "kink");
  refuse({"--implicit", "(x^2+y^2+z^2-1)^2", kBox}, "without a normal");
  refuse({"--implicit", "x^2+y^2+z^2-9", kBox}, "border of the box");
  for (const std::vector<std::string>& other : std::vector<std::vector<std::string>>{
           {"--border", "close"}, {"--start", "persistent"}, {"--restricted", "all"}, {"--max-roughness", "20"}}) {
    refuse({"--implicit", "x^2+y^2+z^2-1", kBox, other[0], other[1]}, other[0]);
  }
  refuse({"--implicit", "x^2+y^2+z^2-1", kBox, "--max-memory", "1G"}, "--max-memory");
  EXPECT_NE(run_on(folder, {"surface", "--help"}).out.find("delsurf2"), std::string::npos);
  EXPECT_EQ(run_on(folder, {"surface", "--implicit", "x^2+y^2+z^2-1", kBox, "--algorithm", "fast", "-o", "s.ply"}).code,
            2);
}

TEST(CliDelSurf2, MeshesASmallVolumeThroughASpline) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_on(folder, {"phantom", "torus", "-o", "torus.nii", "--dims", "14,14,14"}).code, 0);
  const Outcome outcome = run_on(folder, {"surface", "torus.nii", "--iso", "0", "--algorithm", "delsurf2",
                                          "--min-angle", "0", "-o", "torus.ply"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("genus 1"), std::string::npos) << outcome.out;
  const auto check = [&](const std::string& iso, const std::string& interpolation) {
    return run_on(folder, {"check", "torus.ply", "--volume", "torus.nii", "--iso", iso, "--interpolation",
                           interpolation, "--same-topology", "--json"});
  };
  const Outcome of_spline = check("0", "quintic"), elsewhere = check("0.01", "quintic"), of_voxels = check("0", "trilinear");
  EXPECT_EQ(of_spline.code, 0) << of_spline.err;
  EXPECT_EQ(json::parse(of_spline.out)["meshes"][0]["surface_comparison"]["surface_euler"], 0);
  EXPECT_EQ(elsewhere.code, 5) << elsewhere.err;
  EXPECT_NE(elsewhere.err.find("nodes on the surface of the function"), std::string::npos) << elsewhere.err;
  EXPECT_EQ(of_voxels.code, 0) << of_voxels.err;  // its nodes are held to nothing there
  EXPECT_TRUE(json::parse(of_voxels.out)["meshes"][0].contains("comparison"));
  // Of 18 samples the last two are in leaves that no surface crosses: they count all the same.
  ASSERT_EQ(run_on(folder, {"phantom", "sphere", "-o", "ball.nii", "--dims", "18,18,18"}).code, 0);
  const Outcome ball = run_on(folder, {"surface", "ball.nii", "--iso", "0", "--algorithm", "delsurf2", "--max-vertices",
                                       "500", "-o", "ball.ply"});
  EXPECT_EQ(ball.code, 0) << ball.err;
  EXPECT_EQ(run_on(folder, {"check", "ball.ply", "--volume", "ball.nii", "--iso", "0", "--interpolation", "quintic",
                            "--same-topology"}).code, 0);
  const Outcome one = run_on(folder, {"surface", "torus.nii", "--algorithm", "delsurf2", "--largest", "-o", "a.ply"});
  EXPECT_EQ(one.code, 2) << one.err;

  ASSERT_EQ(run_on(folder, {"phantom", "sphere", "-o", "large.nii", "--dims", "33,20,20"}).code, 0);
  const Outcome large = run_on(folder, {"surface", "large.nii", "--iso", "0", "--algorithm", "delsurf2", "-o", "b.ply",
                                        "--quiet"});
  EXPECT_EQ(large.code, 2) << large.err;
  EXPECT_NE(large.err.find("32 x 32 x 32"), std::string::npos) << large.err;
}

TEST(CliFormula, NothingInsideTheBoxIsNothingToMesh) {
  const TemporaryFolder folder;
  const Outcome outcome = run_on(folder, {"tet", "--implicit", "x^2+y^2+z^2+1", kBox, "-o", "out.vtu", "--quiet"});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
}

}  // namespace
}  // namespace delvox::test
