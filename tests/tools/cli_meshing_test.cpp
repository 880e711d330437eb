// The real program from a volume to meshes: what it promises about its output files.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "delvox/mesh_io/read_mesh.h"
#include "delvox/volume/write_volume.h"
#include "tools/run_delvox.h"

namespace delvox::test {
namespace {

using nlohmann::json;

class CliMeshing : public ::testing::Test {
 protected:
  std::string phantom(const std::string& kind, const std::vector<std::string>& more = {}) {
    const std::string path = folder_ / (kind + ".nii");
    std::vector<std::string> arguments{"phantom", kind, "-o", path, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_delvox(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return path;
  }

  // A run that must succeed; returns its JSON.
  json run(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const Outcome outcome = run_delvox(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }

  std::vector<Point3> points_of(const std::string& path) {
    return std::visit([](const auto& mesh) { return mesh.points; }, read_mesh(path).mesh);
  }

  TemporaryFolder folder_;
};

TEST_F(CliMeshing, TheShortestCommandWorksAndSaysWhatItChose) {
  const Outcome outcome = run_delvox({"tet", phantom("sphere"), "-o", folder_ / "mesh.vtu"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("isovalue"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("size"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("every check holds"), std::string::npos) << outcome.out;
}

TEST_F(CliMeshing, SliversAreRemovedUnlessTheyMayStayAndTheMeshPromisesTheAngle) {
  const std::string volume = phantom("torus"), repaired = folder_ / "repaired.vtu", left = folder_ / "left.vtu";
  const json by_default = run({"tet", volume, "--size", "1.5", "-o", repaired});
  EXPECT_GT(by_default["slivers"]["slivers"], 0);
  EXPECT_TRUE(by_default["slivers"]["unmet"].empty());
  EXPECT_GE(by_default["check"]["statistics"]["dihedral_degrees"]["min"], 15);
  const json untouched = run({"tet", volume, "--size", "1.5", "--min-dihedral", "0", "-o", left});
  EXPECT_TRUE(untouched["slivers"].is_null());
  EXPECT_LT(untouched["check"]["statistics"]["dihedral_degrees"]["min"], 15);
  const auto promise = [](const std::string& path) {
    return std::get<TetMesh>(read_mesh(path).mesh).info.promises.min_dihedral_degrees;
  };
  EXPECT_EQ(promise(repaired), 15);
  EXPECT_EQ(promise(left), std::nullopt);
  EXPECT_EQ(run_delvox({"check", repaired, "--volume", volume}).code, 0);
  EXPECT_EQ(run_delvox({"check", left, "--min-dihedral", "15"}).code, 5);
}

TEST_F(CliMeshing, AnAngleThatWasAskedForAndIsNotMetIsABrokenPromiseThatSaysWhere) {
  const std::string volume = phantom("random", {"--dims", "24,24,24", "--seed", "4"}), out = folder_ / "random.vtu";
  const std::vector<std::string> arguments{"tet", volume, "--iso", "1.3", "--size", "0.8", "--min-dihedral", "30", "-o",
                                           out};
  const Outcome outcome = run_delvox(arguments);
  EXPECT_EQ(outcome.code, 5);
  EXPECT_NE(outcome.err.find("warning: a dihedral angle of "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("against 30 deg, at "), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::get<TetMesh>(read_mesh(out).mesh).info.complete);
  std::vector<std::string> quiet = arguments;
  quiet.push_back("--quiet");
  EXPECT_EQ(line_count(run_delvox(quiet).err), 1u);
  EXPECT_EQ(run_delvox({"tet", volume, "--min-dihedral", "31", "-o", out}).code, 2);
  EXPECT_EQ(run_delvox({"surface", volume, "--min-dihedral", "15", "-o", out}).code, 2);
}

TEST_F(CliMeshing, AnIsovalueThatSamplesEqualIsToldWithOneThatNoneDoesAndThatOneHolds) {
  for (const char* seed : {"1", "2", "3"}) {
    const std::string volume = phantom("random", {"--dims", "10,10,10", "--seed", seed});
    // A coarse mesh, and a limit: what is as thin as a rounding error can take for ever to resolve.
    const Outcome tied = run_delvox({"tet", volume, "--iso", "2", "--size", "1.5", "--min-component", "0",
                                     "--max-vertices", "20000", "-o", folder_ / "random.vtu"});
    EXPECT_TRUE(tied.code == 0 || tied.code == 5) << tied.err;
    EXPECT_NE(tied.err.find("equal the isovalue"), std::string::npos) << tied.err;
    EXPECT_NE(tied.err.find("--iso 1.618"), std::string::npos) << tied.err;
    const Outcome untied = run_delvox({"tet", volume, "--iso", "1.618", "--size", "0.5", "--min-component", "0", "-o",
                                       folder_ / "random.vtu"});
    EXPECT_EQ(untied.code, 0) << untied.err;
    EXPECT_EQ(untied.err.find("equal the isovalue"), std::string::npos) << untied.err;
    const Outcome check = run_delvox({"check", folder_ / "random.vtu", "--volume", volume, "--min-component", "0",
                                      "--same-topology", "--quiet"});
    EXPECT_EQ(check.code, 0) << check.err;
  }
}

TEST_F(CliMeshing, QuietSuccessSaysNothing) {
  const Outcome outcome = run_delvox({"tet", phantom("sphere"), "-o", folder_ / "mesh.vtu", "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST_F(CliMeshing, SameInputAndOptionsGiveTheSameBytes) {
  const std::string volume = phantom("torus");
  for (const char* extension : {".vtu", ".stl", ".inp"}) {
    const std::string first = folder_ / (std::string("first") + extension);
    const std::string second = folder_ / (std::string("second") + extension);
    run({"tet", volume, "-o", first});
    run({"tet", volume, "-o", second});
    EXPECT_EQ(read_file(first), read_file(second)) << extension;
    EXPECT_FALSE(read_file(first).empty());
  }
}

TEST_F(CliMeshing, SeveralOutputsHoldTheSameMesh) {
  const std::string vtu = folder_ / "mesh.vtu", inp = folder_ / "mesh.inp", stl = folder_ / "mesh.stl";
  run({"tet", phantom("sphere"), "-o", vtu, "-o", inp, "-o", stl});
  EXPECT_EQ(points_of(vtu).size(), points_of(inp).size());
  EXPECT_LT(points_of(stl).size(), points_of(vtu).size());
}

TEST_F(CliMeshing, TheReportTellsOptionsVolumeAndChecks) {
  const std::string path = folder_ / "report.json";
  run({"tet", phantom("sphere"), "--size", "4", "-o", folder_ / "mesh.vtu", "--report", path});
  const json report = json::parse(read_file(path));
  EXPECT_EQ(report["options"]["size"], 4);
  EXPECT_EQ(report["options"]["min-angle"], 30);
  EXPECT_EQ(report["volume"]["dims"], json::array({64, 64, 64}));
  EXPECT_EQ(report["command"][1], "tet");
  EXPECT_TRUE(report["check"]["all_hold"].get<bool>());
  EXPECT_EQ(report["check"]["statistics"]["euler"], 2);
  EXPECT_EQ(report["outputs"].size(), 1u);
}

TEST_F(CliMeshing, FlagsWinOverTheConfigFile) {
  const std::string volume = phantom("sphere"), config = folder_ / "config.json";
  write_file(config, R"({"size": 6, "min-angle": 25, "below": false, "output": [")" + (folder_ / "mesh.vtu") + R"("]})");
  const json both = run({"tet", volume, "--config", config, "--size", "5"});
  EXPECT_EQ(both["options"]["size"], 5);
  EXPECT_EQ(both["options"]["min-angle"], 25);
  EXPECT_EQ(both["mesh"]["promises"]["size_mm"], 5);
  EXPECT_EQ(both["mesh"]["promises"]["min_angle_degrees"], 25);
}

TEST_F(CliMeshing, TetsFindsASizeThatGivesAboutThatMany) {
  const json report = run({"tet", phantom("sphere"), "--tets", "20000", "-o", folder_ / "mesh.vtu"});
  EXPECT_NEAR(report["check"]["statistics"]["tets"].get<double>(), 20000, 0.04 * 20000);
}

// 125 equal balls, each below the default of --min-component at the first guess of a size.
TEST_F(CliMeshing, TetsFindsASizeWhereTheFirstGuessTakesEveryComponentOut) {
  VolumeHeader header;
  header.dims = {40, 40, 40};
  std::vector<float> samples;
  const auto offset = [](int i) { return i % 8 - 3.5; };
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) samples.push_back(float(2.7 - norm(Vector3{offset(i), offset(j), offset(k)})));
    }
  }
  const std::string volume = folder_ / "balls.nii";
  write_volume(Volume(header, samples), volume);
  const Outcome outcome = run_delvox({"tet", volume, "--iso", "0", "--tets", "2400", "-o", folder_ / "mesh.vtu"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("all components are below"), std::string::npos) << outcome.err;
  const json report = run({"tet", volume, "--iso", "0", "--tets", "6000", "-o", folder_ / "mesh.vtu"});
  EXPECT_NEAR(report["check"]["statistics"]["tets"].get<double>(), 6000, 0.04 * 6000);
  EXPECT_EQ(report["components"]["kept"], 125);
  // With a --min-component of the user's own no size helps.
  EXPECT_EQ(run_delvox({"tet", volume, "--iso", "0", "--tets", "6000", "--min-component", "200", "-o",
                        folder_ / "mesh.vtu", "--quiet"}).code, 4);
}

TEST_F(CliMeshing, TheOtherFrameTurnsXAndY) {
  const std::string volume = phantom("sphere", {"--center", "10,20,30"});
  const std::string ras = folder_ / "ras.vtu", lps = folder_ / "lps.vtu";
  run({"tet", volume, "--size", "5", "-o", ras});
  EXPECT_EQ(run({"tet", volume, "--size", "5", "--frame", "lps", "-o", lps})["mesh"]["frame"], "LPS");
  const std::vector<Point3> a = points_of(ras), b = points_of(lps);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(b[i], (Point3{-a[i].x, -a[i].y, a[i].z}));
  for (const std::string& mesh : {ras, lps}) run({"check", mesh, "--volume", volume});
}

TEST_F(CliMeshing, WorldPointsOfFlagsAreInTheOutputFrame) {
  const std::string volume = phantom("sphere", {"--center", "10,20,30"});
  const json ras = run({"tet", volume, "--size", "5", "--crop", "5:90,:,:mm", "--iso", "at:25,20,30", "-o", folder_ / "a.vtu"});
  const json lps = run({"tet", volume, "--size", "5", "--crop", "-90:-5,:,:mm", "--iso", "at:-25,-20,30", "--frame", "lps",
                        "-o", folder_ / "b.vtu"});
  EXPECT_EQ(ras["isovalue"], lps["isovalue"]);
  EXPECT_EQ(ras["meshed_volume"]["dims"], lps["meshed_volume"]["dims"]);
  EXPECT_LT(ras["meshed_volume"]["dims"][0], 64);
}

TEST_F(CliMeshing, AnOpenBorderEndsWhereTheImageEnds) {
  const std::string volume = phantom("border");
  const json closed = run({"surface", volume, "-o", folder_ / "closed.vtu"});
  const json open = run({"surface", volume, "--border", "open", "-o", folder_ / "open.vtu"});
  EXPECT_TRUE(open["mesh"]["open_border"].get<bool>());
  EXPECT_LT(open["check"]["statistics"]["triangles"], closed["check"]["statistics"]["triangles"]);
  EXPECT_EQ(run_delvox({"check", folder_ / "open.vtu", "--quiet"}).code, 0);
}

TEST_F(CliMeshing, AVolumeCanBeTheSizeField) {
  const std::string volume = phantom("sphere");
  VolumeHeader header;
  header.dims = {2, 1, 1};
  header.frame = Frame::kRas;
  header.index_to_world.rows[0] = {40, 0, 0, -20};
  const std::string sizes = folder_ / "sizes.nii";  // from 3 mm at x = -20 to 9 mm at x = 20
  write_volume(Volume(header, {3, 9}), sizes);
  const json report = run({"tet", volume, "--size", sizes, "-o", folder_ / "mesh.vtu"});
  EXPECT_EQ(report["mesh"]["promises"]["size_mm"], 9);
  std::size_t left = 0, right = 0;
  for (const Point3& p : points_of(folder_ / "mesh.vtu")) ++(p.x < 0 ? left : right);
  EXPECT_GT(left, 3 * right);
  // A signed distance cannot be a size.
  EXPECT_EQ(run_delvox({"tet", volume, "--size", volume, "-o", folder_ / "bad.vtu", "--quiet"}).code, 3);
}

TEST_F(CliMeshing, TetsGrowWithDepthUpToTheCellSize) {
  const std::string volume = phantom("ellipsoid", {"--spacing", "1,1,2"}), out = folder_ / "mesh.vtu";
  const std::vector<std::string> options{"--crop", "10:54,10:64,8:64", "--size", "1.5", "-o", out};
  const auto tets_with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"tet", volume});
    more.insert(more.end(), options.begin(), options.end());
    const json report = run(more);
    EXPECT_TRUE(report["check"]["all_hold"].get<bool>());
    return report["check"]["statistics"]["tets"].get<std::size_t>();
  };
  const std::size_t even = tets_with({}), growing = tets_with({"--grade", "0.4"});
  EXPECT_LT(growing, even / 2);
  const Outcome check = run_delvox({"check", out});
  EXPECT_EQ(check.code, 0) << check.out;
  EXPECT_NE(check.out.find("graded cell size"), std::string::npos) << check.out;
  const std::size_t capped = tets_with({"--grade", "0.4", "--cell-size", "2"});
  EXPECT_GT(capped, growing);
  EXPECT_LT(capped, even);
  EXPECT_EQ(std::get<TetMesh>(read_mesh(out).mesh).info.promises.cell_size, 2);
  EXPECT_LT(tets_with({"--below", "--grade", "0.4"}), tets_with({"--below"}));  // what surrounds it
  EXPECT_EQ(tets_with({"--grade", "0"}), even);
  EXPECT_EQ(run_delvox({"tet", volume, "--grade", "1.5", "-o", out, "--quiet"}).code, 2);
  EXPECT_EQ(run_delvox({"surface", volume, "--grade", "0.5", "-o", out, "--quiet"}).code, 2);
}

TEST_F(CliMeshing, TetsThatGrowCanBeAskedForByTheirNumber) {
  const json report = run({"tet", phantom("sphere"), "--tets", "20000", "--grade", "0.3", "-o", folder_ / "mesh.vtu"});
  EXPECT_NEAR(report["check"]["statistics"]["tets"].get<double>(), 20000, 0.04 * 20000);
  EXPECT_EQ(report["mesh"]["promises"]["grade"], 0.3);
}

TEST_F(CliMeshing, SmallComponentsAreTakenOutAndCounted) {
  const std::string volume = phantom("noisy-sphere");
  const json report = run({"tet", volume, "--iso", "otsu", "-o", folder_ / "mesh.vtu"});
  EXPECT_EQ(report["components"]["kept"], 1);
}

}  // namespace
}  // namespace delvox::test
