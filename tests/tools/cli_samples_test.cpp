// The real program on scattered samples: info, surface, tet, check --samples, and what is refused.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "support/test_samples.h"
#include "tools/cli_fixture.h"

namespace delvox::test {
namespace {

using nlohmann::json;

std::string csv_of(const Samples& samples) {
  std::string text = "x,y,z,value\n";
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Point3& p = samples.points[i];
    char line[128];
    std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%.17g\n", p.x, p.y, p.z, samples.values[i]);
    text += line;
  }
  return text;
}

class CliSamples : public CliFixture {
 protected:
  std::string write(const std::string& name, const Samples& samples) {
    write_file(folder_ / name, csv_of(samples));
    return folder_ / name;
  }
};

const double kBallMm3 = 4.0 / 3 * std::numbers::pi * 0.7 * 0.7 * 0.7;

TEST_F(CliSamples, ABallOf20000SamplesHasItsVolumeTopologyAndNodesOnTheInterpolant) {
  const std::string samples = write("ball.csv", with_values(lattice_of_places(27, 0.4, 1), ball));
  for (const char* verb : {"surface", "tet"}) {
    const std::string mesh = folder_ / (std::string(verb) + ".vtu");
    const json report = run({verb, samples, "--iso", "0", "--size", "0.07", "-o", mesh});
    EXPECT_EQ(report["samples"]["count"], 27 * 27 * 27);
    EXPECT_EQ(report["closed_along_hull"], false);
    EXPECT_EQ(report["mesh"]["isovalue"], 0);
    EXPECT_EQ(report["check"]["statistics"]["euler"], 2);
    const double inside = report["inside_mm3"];  // of the linear interpolant, exactly
    EXPECT_NEAR(inside / kBallMm3, 1, 0.01);
    EXPECT_NEAR(report["check"]["statistics"]["volume_mm3"].get<double>() / inside, 1, 0.01);
    const json check = run({"check", mesh, "--samples", samples, "--same-topology"})["meshes"][0];
    for (const json& one : check["checks"]) {
      if (one["name"] == "nodes on the surface") {
        EXPECT_LT(one["measured"].get<double>(), 1e-9);
      }
    }
    EXPECT_LT(check["surface_comparison"]["mesh_to_surface_max_mm"].get<double>(), 0.01);
    EXPECT_LT(check["surface_comparison"]["surface_to_mesh_max_mm"].get<double>(), 0.02);
  }
}

TEST_F(CliSamples, BothInterpolationsMeshATorusOfScatteredSamples) {
  const std::string samples = write("torus.csv", with_values(lattice_of_places(24, 0.4, 2), torus));
  const double truth = 2 * std::numbers::pi * std::numbers::pi * 0.6 * 0.25 * 0.25;
  for (const std::string how : {"linear", "natural"}) {
    const json report = run(
        {"surface", samples, "--iso", "0", "--size", "0.07", "--interpolation", how, "-o", folder_ / (how + ".ply")});
    EXPECT_EQ(report["check"]["statistics"]["euler"], 0) << how;
    EXPECT_EQ(report["check"]["statistics"]["surface_components"], 1) << how;
    EXPECT_EQ(report["samples"]["interpolation"], how);
    EXPECT_NEAR(report["check"]["statistics"]["volume_mm3"].get<double>() / truth, 1, 0.06) << how;
  }
}

TEST_F(CliSamples, TheInsideClosesAlongTheHullAndTheRunSaysSo) {
  const std::string samples =
      write("plane.csv", with_values(cube_of_places(500, 3), [](const Point3& p) { return p.x + p.y / 3; }));
  const std::string mesh = folder_ / "plane.vtu";
  const Outcome outcome = run_delvox({"tet", samples, "--iso", "0.2", "--size", "0.1", "-o", mesh});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("closes along it"), std::string::npos) << outcome.err;
  const json check = run({"check", mesh, "--samples", samples, "--same-topology"})["meshes"][0];
  EXPECT_NEAR(check["statistics"]["volume_mm3"].get<double>(), 3.2, 0.05);
  const json below = run({"tet", samples, "--iso", "0.2", "--below", "--size", "0.1", "-o", folder_ / "below.vtu"});
  EXPECT_NEAR(below["check"]["statistics"]["volume_mm3"].get<double>(), 4.8, 0.05);
}

TEST_F(CliSamples, TheSizeAndTheIsovalueHaveDefaultsAndTetsCanBeCounted) {
  const std::string samples = write("ball.csv", with_values(lattice_of_places(15, 0.3, 4), ball));
  const Outcome outcome = run_delvox({"surface", samples, "-o", folder_ / "a.ply"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("Otsu's threshold"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("from the extent of the inside and the spacing of the samples"), std::string::npos);
  EXPECT_NE(outcome.err.find("3,375 samples of 'value'"), std::string::npos) << outcome.err;
  const json report = run({"tet", samples, "--iso", "0", "--tets", "5000", "-o", folder_ / "b.vtu"});
  EXPECT_NEAR(report["check"]["statistics"]["tets"].get<double>(), 5000, 500);
  EXPECT_EQ(run({"surface", samples, "--iso", "at:0,0,0.5", "-o", folder_ / "c.ply"})["below"], false);
}

TEST_F(CliSamples, InfoTellsWhatIsThereAndWhichIsovaluesMakeSense) {
  const std::string samples = write("ball.csv", with_values(lattice_of_places(15, 0, 5), ball));
  const json info = run({"info", samples});
  EXPECT_EQ(info["samples"]["count"], 3375);
  EXPECT_EQ(info["samples"]["box"][0], json({-1, -1, -1}));
  EXPECT_NEAR(info["samples"]["hull_mm3"].get<double>(), 8, 1e-9);
  EXPECT_NEAR(info["max"].get<double>(), 0.7, 1e-6);
  EXPECT_EQ(info["isovalues"].size(), 6u);
  EXPECT_EQ(info["isovalues"][0]["iso"], "otsu");
  EXPECT_EQ(info["isovalues"][0]["euler"], 2);
  EXPECT_EQ(info["isovalues"][0]["inside_components"], 1);
  const Outcome text = run_delvox({"info", samples});
  for (const char* word : {"3,375 samples", "box", "hull", "range", "otsu3:2"}) {
    EXPECT_NE(text.out.find(word), std::string::npos) << text.out;
  }
  const json below = run({"info", samples, "--below"});
  EXPECT_EQ(below["isovalues"][0]["cavities"], 1);
  EXPECT_EQ(below["isovalues"][0]["surface_components"], 2);
}

TEST_F(CliSamples, NodesOfATetMeshWithAnArrayBecomeSamples) {
  const std::string source = folder_ / "source.vtu";
  run({"tet", "--implicit", "x^2+y^2+z^2-1", "--box=-2:2,-2:2,-2:2", "--size", "0.15", "-o", source});
  std::string bytes = read_file(source);
  const std::size_t count = std::stoul(bytes.substr(bytes.find("NumberOfPoints=\"") + 16));
  std::string array = "<DataArray type=\"Float64\" Name=\"heat\" format=\"ascii\">";
  for (std::size_t i = 0; i < count; ++i) array += i % 7 == 0 ? " 2" : " 1";
  bytes.insert(bytes.find('>', bytes.find("<PointData")) + 1, array + "</DataArray>");
  const std::string samples = folder_ / "samples.vtu";
  write_file(samples, bytes);
  EXPECT_EQ(run({"info", samples})["samples"]["field"], "heat");
  const json report =
      run({"surface", samples, "--field", "heat", "--iso", "1.5", "--below", "--size", "0.1", "-o", folder_ / "a.ply"});
  EXPECT_EQ(report["samples"]["count"], count);
  expect_failure(3, {"surface", samples, "--field", "cold", "-o", folder_ / "b.ply"}, {"samples.vtu", "'heat'"});
  expect_failure(3, {"surface", source, "--iso", "1", "-o", folder_ / "b.ply"}, {"source.vtu", "no array"});
  expect_failure(2, {"surface", samples, "-o", folder_ / "b.ply"}, {"remesh"});  // as any .vtu
}

TEST_F(CliSamples, BadSamplesAndOptionsThatMakeNoSenseAreRefused) {
  const std::string good = write("good.csv", with_values(cube_of_places(50, 6), ball)), out = folder_ / "out.vtu";
  write_file(folder_ / "three.csv", "0,0,0,1\n1,0,0,2\n0,1,0,3\n");
  write_file(folder_ / "flat.csv", "0,0,1,1\n1,0,1,2\n0,1,1,3\n1,1,1,5\n3,1,1,5\n");
  write_file(folder_ / "thin.csv", "0,0,0,1\n1,0,0,0\n0,1,0,0\n0,0,1e-15,0\n");
  write_file(folder_ / "twins.csv", "x,y,z,value,value\n0,0,0,1,2\n1,0,0,2,1\n0,1,0,3,1\n0,0,1,4,1\n");
  write_file(folder_ / "two.csv", "0,0,0,1\n1,0,0,2\n0,1,0,3\n0,0,1,4\n0,0,1,5\n");
  write_file(folder_ / "word.csv", "0,0,0,1\n1,0,0,two\n0,1,0,3\n0,0,1,4\n");
  write_file(folder_ / "nan.csv", "0,0,0,1\n1,0,0,nan\n0,1,0,3\n0,0,1,4\n");
  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"info"}, {"surface", "-o", out}, {"tet", "-o", out}}) {
    const auto refuse = [&](const std::string& name, const std::vector<std::string>& words) {
      std::vector<std::string> arguments = verb;
      arguments.insert(arguments.begin() + 1, folder_ / name);
      expect_failure(3, arguments, words);
    };
    refuse("missing.csv", {"missing.csv"});
    refuse("three.csv", {"three.csv", "3 places"});
    refuse("flat.csv", {"flat.csv", "one plane"});
    refuse("thin.csv", {"thin.csv", "one plane, nearly"});
    refuse("twins.csv", {"two columns 'value'"});
    refuse("two.csv", {"line 4 and line 5"});
    refuse("word.csv", {"line 2", "'two'"});
    refuse("nan.csv", {"line 2", "not finite"});
  }
  for (const char* iso : {"0.71", "-2"})
    expect_failure(4, {"tet", good, "--iso", iso, "-o", out}, {"range of the samples"});
  expect_failure(2, {"tet", good, "--iso", "at:9,9,9", "-o", out}, {"convex hull"});
  expect_failure(2, {"tet", good, "--iso", "zero", "-o", out}, {"zero"});
  expect_failure(2, {"tet", good, "--smooth", "1", "-o", out}, {"--smooth", "volumes"});
  expect_failure(2, {"surface", good, "--border", "open", "-o", out}, {"--border", "volumes"});
  expect_failure(2, {"surface", good, "--algorithm", "delsurf2", "-o", out}, {"delsurf2"});
  expect_failure(2, {"surface", good, "--interpolation", "cubic", "-o", out}, {"--interpolation"});
  expect_failure(2, {"info", good, "--crop", "0:1,0:1,0:1"}, {"--crop"});
  expect_failure(2, {"surface", good, "--size", "curvature", "-o", out}, {"curvature"});
  expect_failure(2, {"tet", "--implicit", "x", "--box=-1:1,-1:1,-1:1", "--field", "a", "-o", out}, {"--field"});
  const std::string volume = folder_ / "v.nii";
  ASSERT_EQ(run_delvox({"phantom", "sphere", "-o", volume, "--quiet"}).code, 0);
  expect_failure(2, {"tet", volume, "--interpolation", "natural", "-o", out}, {"scattered samples"});
  expect_failure(2, {"info", volume, "--field", "a"}, {"--field"});
}

TEST_F(CliSamples, ThreadsAndRunsDoNotChangeAByte) {
  const std::string samples = write("torus.csv", with_values(lattice_of_places(14, 0.4, 7), torus));
  for (const std::string how : {"linear", "natural"}) {
    std::string first;
    for (const std::string threads : {"1", "2", "4", "2"}) {
      const std::string out = folder_ / "out.vtu";
      const Outcome outcome = run_delvox({"tet", samples, "--iso", "0", "--size", how == "linear" ? "0.05" : "0.1",
                                          "--interpolation", how, "--threads", threads, "-o", out, "--quiet"});
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const std::string bytes = read_file(out);
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first) << how << " with " << threads << " threads";
    }
  }
}

}  // namespace
}  // namespace delvox::test
