// The real program on polygon surfaces: remesh, tet, check --surface, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "delvox/mesh_io/write_mesh.h"
#include "support/sharp_shapes.h"
#include "tools/cli_fixture.h"

namespace delvox::test {
namespace {

using nlohmann::json;

class CliPolygons : public CliFixture {
 protected:
  std::string write(const std::string& name, const SurfaceMesh& mesh) {
    write_mesh(mesh, folder_ / name);
    return folder_ / name;
  }
};

TEST_F(CliPolygons, TheShortestCommandsWorkAndSayWhatSizeTheyTook) {
  const std::string sphere = write("sphere.stl", icosphere(3, 10));
  for (const char* verb : {"remesh", "tet"}) {
    const std::string out = folder_ / (std::string(verb) + ".vtu");
    const Outcome outcome = run_delvox({verb, sphere, "-o", out});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("1/60 of the surface's diagonal"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("forecast: about"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find("every check holds"), std::string::npos) << outcome.out;
    const Outcome check = run_delvox({"check", out, "--surface", sphere, "--same-topology"});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_NE(check.out.find("mesh to surface: max"), std::string::npos) << check.out;
  }
}

TEST_F(CliPolygons, NodesLieOnTheInputAndTheMeshIsAsNearAsTheSizeAsks) {
  const std::string sphere = write("sphere.off", icosphere(4, 10)), out = folder_ / "out.vtu";
  run({"remesh", sphere, "--size", "1", "-o", out});
  const json check = run({"check", out, "--surface", sphere})["meshes"][0];
  // Within a ball of radius 1 a sphere of radius 10 bulges by 0.05; the input's own facets add a third of that.
  EXPECT_LT(check["surface_comparison"]["mesh_to_surface_max_mm"].get<double>(), 0.07);
  EXPECT_LT(check["surface_comparison"]["surface_to_mesh_max_mm"].get<double>(), 0.07);
  for (const json& one : check["checks"]) {
    if (one["name"] == "nodes on the surface") {
      EXPECT_LT(one["measured"].get<double>(), 1e-12);
    }
  }
}

TEST_F(CliPolygons, ShellsWithinShellsKeepTheirComponentsAndCavities) {
  SurfaceMesh shells = icosphere(3, 10);
  append(shells, icosphere(3, 7));  // faces outward, is a cavity all the same
  append(shells, inverted(icosphere(3, 4)));
  const json report = run({"tet", write("shells.ply", shells), "--size", "1", "-o", folder_ / "out.vtu"});
  EXPECT_EQ(report["check"]["statistics"]["surface_components"], 3);
  EXPECT_EQ(report["check"]["statistics"]["cavities"], 1);
  EXPECT_EQ(report["check"]["statistics"]["euler"], 6);
  EXPECT_EQ(report["surface"]["euler"], 6);
  EXPECT_NEAR(report["check"]["statistics"]["volume_mm3"].get<double>(), 4.18879 * (1000 - 343 + 64), 60);
}

TEST_F(CliPolygons, ASharpCubeIsMeshedToo) {
  const json report = run({"tet", write("cube.obj", boundary_surface(cube_mesh(1, 10))), "-o", folder_ / "out.vtu"});
  EXPECT_TRUE(report["check"]["all_hold"].get<bool>());
  EXPECT_EQ(report["check"]["statistics"]["euler"], 2);
}

TEST_F(CliPolygons, TheBoundaryOfATetMeshIsASurfaceToo) {
  write_mesh(cube_mesh(2, 5), folder_ / "tets.vtu");
  const json report = run({"remesh", folder_ / "tets.vtu", "--size", "1", "-o", folder_ / "out.stl"});
  EXPECT_EQ(report["surface"]["euler"], 2);
}

TEST_F(CliPolygons, PartsThinnerThanTheSizeAreToldIfTheMeshLacksThem) {
  // Two flat plates a hair apart: at this size they may come out as one piece, or as two; the run says which.
  SurfaceMesh plates = boundary_surface(cube_mesh(4, 2.5));
  append(plates, boundary_surface(cube_mesh(4, 2.5, {0, 0, 10.001})));
  const std::string input = write("plates.off", plates), out = folder_ / "out.ply";
  const Outcome run = run_delvox({"remesh", input, "--size", "3", "-o", out});
  EXPECT_EQ(run.code, 0) << run.err;
  const bool same = run_delvox({"check", out, "--surface", input, "--same-topology", "--quiet"}).code == 0;
  EXPECT_EQ(run.out.find("left over: topology") == std::string::npos, same) << run.out;
}

TEST_F(CliPolygons, SameInputAndOptionsGiveTheSameBytesForAnyNumberOfThreads) {
  const std::string sphere = write("sphere.ply", icosphere(4, 10));
  for (const char* verb : {"remesh", "tet"}) {
    for (const char* threads : {"1", "2"}) run({verb, sphere, "--threads", threads, "-o", folder_ / (std::string(threads) + ".vtu")});
    EXPECT_EQ(read_file(folder_ / "1.vtu"), read_file(folder_ / "2.vtu"));
  }
}

TEST_F(CliPolygons, SharpEdgesAreKeptAndWhatTouchesThemIsCountedApart) {
  const std::string input = write("notch.off", notched_cube());
  for (const char* verb : {"remesh", "tet"}) {
    const std::string out = folder_ / (std::string(verb) + ".vtu");
    const json report = run({verb, input, "--size", "1", "--feature-angle", "60", "-o", out});
    const json& features = report["check"]["features"];
    EXPECT_EQ(features["missing_mm"], 0);
    EXPECT_NEAR(features["length_mm"].get<double>(), 12 * 10 - 2 * 2.5 + 4 * 10 + 4 * 5 + 2 * 2.5, 1e-9);
    EXPECT_GT(features["kept_edges"].get<int>(), 150);
    EXPECT_GT(features["triangles"].get<int>(), 300);
    EXPECT_TRUE(features.contains("triangles_below_min_angle"));
    EXPECT_NEAR(report["check"]["statistics"]["volume_mm3"].get<double>(), 1000 - 2.5 * 5 * 10, 1e-6);
    EXPECT_EQ(report["mesh"]["promises"]["feature_angle_degrees"], 60);
    // The mesh says at what angle; what it is compared with tells where.
    const Outcome check = run_delvox({"check", out, "--surface", input, "--same-topology"});
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    EXPECT_NE(check.out.find("sharp edges (normals more than 60 deg apart)"), std::string::npos) << check.out;
    EXPECT_NE(check.out.find("at sharp edges, where bounds on shapes do not hold"), std::string::npos) << check.out;
    EXPECT_EQ(run_delvox({"check", out, "--quiet"}).code, 0);
  }
}

TEST_F(CliPolygons, CheckTellsWhatIsMissingOfSharpEdges) {
  const std::string input = write("cube.off", boundary_surface(cube_mesh(1, 10))), out = folder_ / "out.vtu";
  run({"remesh", input, "--size", "1", "-o", out});
  EXPECT_EQ(run_delvox({"check", out, "--surface", input, "--quiet"}).code, 0);
  expect_failure(5, {"check", out, "--surface", input, "--feature-angle", "60"}, {"out.vtu", "sharp edges kept"});
}

TEST_F(CliPolygons, SharpEdgesTurnWithTheFrame) {
  SurfaceMesh cube = boundary_surface(cube_mesh(1, 10, {100, 50, 25}));
  cube.info.frame = Frame::kRas;
  const json report = run({"tet", write("cube.vtk", cube), "--size", "2", "--feature-angle", "60", "--frame", "lps", "-o",
                           folder_ / "lps.vtu"});
  EXPECT_EQ(report["check"]["features"]["missing_mm"], 0);
}

TEST_F(CliPolygons, SharpEdgesComeOutTheSameForAnyNumberOfThreads) {
  const std::string input = write("cylinder.off", polygonal_cylinder(36, 5, 10));
  for (const char* verb : {"remesh", "tet"}) {
    for (const char* threads : {"1", "2", "4"}) {
      run({verb, input, "--size", "0.8", "--feature-angle", "60", "--threads", threads, "-o",
           folder_ / (std::string(threads) + ".vtu")});
    }
    EXPECT_EQ(read_file(folder_ / "1.vtu"), read_file(folder_ / "2.vtu"));
    EXPECT_EQ(read_file(folder_ / "1.vtu"), read_file(folder_ / "4.vtu"));
  }
}

TEST_F(CliPolygons, WhatSharpEdgesCannotGoWithIsAUsageError) {
  const std::string cube = write("cube.off", boundary_surface(cube_mesh(1, 10))), out = folder_ / "out.vtu";
  for (const char* angle : {"0", "-5", "181", "nan", "sharp"}) {
    expect_failure(2, {"remesh", cube, "--feature-angle", angle, "-o", out}, {"--feature-angle"});
  }
  expect_failure(2, {"tet", folder_ / "scan.nii", "--feature-angle", "60", "-o", out}, {"--feature-angle", "scan.nii"});
  expect_failure(2, {"tet", "--implicit", "x^2+y^2+z^2-1", "--box=-2:2,-2:2,-2:2", "--feature-angle", "60", "-o", out},
                 {"--feature-angle", "--implicit"});
  expect_failure(2, {"surface", folder_ / "scan.nii", "--feature-angle", "60", "-o", out}, {"--feature-angle"});
  expect_failure(2, {"remesh", cube, "--feature-angle", "60", "--start", "persistent", "-o", out}, {"--start"});
  expect_failure(2, {"tet", cube, "--feature-angle", "60", "--restricted", "all", "-o", out}, {"--restricted"});
  expect_failure(2, {"remesh", cube, "--feature-angle", "60", "--algorithm", "delsurf1", "-o", out}, {"--algorithm"});
  expect_failure(2, {"check", cube, "--feature-angle", "60"}, {"--feature-angle", "--surface"});
}

TEST_F(CliPolygons, TetsFindsASizeForAPolygonSurface) {
  const json report =
      run({"tet", write("sphere.stl", icosphere(4, 10)), "--tets", "20000", "-o", folder_ / "mesh.vtu"});
  EXPECT_NEAR(report["check"]["statistics"]["tets"].get<double>(), 20000, 0.04 * 20000);
}

TEST_F(CliPolygons, TheFrameOfTheFileIsKeptOrTurned) {
  SurfaceMesh sphere = icosphere(2, 10, {100, 50, 25});
  sphere.info.frame = Frame::kRas;
  const std::string input = write("sphere.vtk", sphere);
  EXPECT_EQ(run({"remesh", input, "-o", folder_ / "ras.vtu"})["mesh"]["frame"], "RAS");
  const json turned = run({"remesh", input, "--frame", "lps", "-o", folder_ / "lps.vtu"});
  EXPECT_EQ(turned["mesh"]["frame"], "LPS");
  EXPECT_EQ(run_delvox({"check", folder_ / "lps.vtu", "--surface", input, "--quiet"}).code, 0);
  const json check = run({"check", folder_ / "lps.vtu", "--surface", input})["meshes"][0];
  EXPECT_LT(check["surface_comparison"]["mesh_to_surface_max_mm"].get<double>(), 1);
}

TEST_F(CliPolygons, WhatHasNoSenseForPolygonsIsAUsageError) {
  const std::string sphere = write("sphere.stl", icosphere(2, 10)), out = folder_ / "out.vtu";
  expect_failure(2, {"tet", sphere, "--iso", "3", "-o", out}, {"--iso", "sphere.stl"});
  expect_failure(2, {"tet", sphere, "--smooth", "1", "-o", out}, {"--smooth"});
  expect_failure(2, {"tet", sphere, "--min-component", "1", "-o", out}, {"--min-component"});
  expect_failure(2, {"tet", sphere, "--below", "-o", out}, {"--below"});
  expect_failure(2, {"remesh", sphere, "--iso", "3", "-o", out}, {"--iso"});
  expect_failure(2, {"remesh", sphere, "--border", "open", "-o", out}, {"--border"});
  expect_failure(2, {"surface", sphere, "-o", out}, {"sphere.stl", "delvox remesh"});
  expect_failure(2, {"remesh", sphere, "-o", sphere}, {"input"});
  expect_failure(2, {"check", sphere, "--same-topology"}, {"--same-topology", "--surface"});
  expect_failure(3, {"remesh", folder_ / "scan.nii", "-o", out}, {"scan.nii", ".stl"});
}

TEST_F(CliPolygons, OpenPinchedAndCrossingSurfacesAreRefusedWithTheReasonAndThePlace) {
  const std::string out = folder_ / "out.vtu";
  SurfaceMesh open = icosphere(2);
  open.triangles.erase(open.triangles.begin() + 7);
  SurfaceMesh crossing = icosphere(2);
  append(crossing, icosphere(2, 1, {1, 0.1, 0.2}));
  SurfaceMesh pinched = boundary_surface(cube_mesh());
  append(pinched, boundary_surface(cube_mesh(1, 1, {1, 1, 1})));
  for (const char* verb : {"remesh", "tet"}) {
    expect_failure(3, {verb, write("open.ply", open), "-o", out}, {"open.ply", "open: 3 edges", "triangle "});
    expect_failure(3, {verb, write("crossing.off", crossing), "-o", out}, {"crossing.off", "crosses itself", "near"});
    expect_failure(3, {verb, write("pinched.obj", pinched), "-o", out}, {"pinched.obj", "not manifold", "at 1, 1, 1"});
  }
}

}  // namespace
}  // namespace delvox::test
