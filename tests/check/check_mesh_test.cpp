#include "delvox/check/check_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "support/test_meshes.h"

namespace delvox {
namespace {

using test::append;
using test::cube_mesh;
using test::icosphere;
using test::inverted;

std::set<std::string> failures(const CheckReport& report) {
  std::set<std::string> names;
  for (const Check& check : report.checks) {
    if (check.status == CheckStatus::kFailed) names.insert(check.name);
  }
  return names;
}

std::set<std::string> failures(const Mesh& mesh, const CheckOptions& options = {}) {
  return failures(check_mesh(mesh, options));
}

using Names = std::set<std::string>;

SurfaceMesh tetrahedron(Point3 a, Point3 b, Point3 c, Point3 d) {
  SurfaceMesh mesh;
  mesh.points = {a, b, c, d};
  for (const auto& f : kTetFaces) {
    mesh.triangles.push_back({std::uint32_t(f[0]), std::uint32_t(f[1]), std::uint32_t(f[2])});
  }
  return mesh;
}

TEST(CheckMesh, CubeOfTetsHoldsEverything) {
  const CheckReport report = check_mesh(cube_mesh(3, 0.5));
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  EXPECT_EQ(report.statistics.tets, 162u);
  EXPECT_EQ(report.statistics.triangles, 108u);
  EXPECT_EQ(report.statistics.euler, 2);
  EXPECT_EQ(report.statistics.tet_components, 1u);
  EXPECT_NEAR(report.statistics.volume_mm3, 1.5 * 1.5 * 1.5, 1e-12);
  EXPECT_NEAR(report.statistics.area_mm2, 6 * 1.5 * 1.5, 1e-12);
  EXPECT_NEAR(report.statistics.dihedral_degrees.min, 45, 1e-9);
  EXPECT_NEAR(report.statistics.dihedral_degrees.max, 90, 1e-9);
  EXPECT_NEAR(report.find("radius-edge")->measured, std::sqrt(3.0) / 2, 1e-12);
}

// Tets are measured two at a time: an odd one, too, and each once.
TEST(CheckMesh, MeasuresEveryTetOnce) {
  const TetMesh mesh = cube_mesh(3, 0.5);
  for (std::size_t tets : {1, 2, 3, 161}) {
    TetMesh part = mesh;
    part.tets.resize(tets);
    part.regions.clear();
    part.boundary.clear();
    part.on_surface.clear();
    const MeshStatistics statistics = check_mesh(part).statistics;
    EXPECT_EQ(statistics.dihedral_degrees.count, 6 * tets);
    EXPECT_EQ(statistics.radius_edge.count, tets);
    EXPECT_NEAR(statistics.volume_mm3, static_cast<double>(tets) * 1.5 * 1.5 * 1.5 / 162, 1e-12);
  }
}

TEST(CheckMesh, IcosphereHoldsEverything) {
  const CheckReport report = check_mesh(icosphere(3, 10, {1, 2, 3}));
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  EXPECT_EQ(report.statistics.euler, 2);
  EXPECT_EQ(report.statistics.components.at(0).genus, 0);
  EXPECT_NEAR(report.statistics.volume_mm3, 4188.8, 50);
}

TEST(CheckMesh, RoughnessIsMeasuredAndHeldToItsBound) {
  const SurfaceMesh cube = boundary_surface(cube_mesh());
  CheckReport report = check_mesh(cube);
  EXPECT_NEAR(report.find("roughness")->measured, 90, 1e-9);
  EXPECT_EQ(report.find("roughness")->status, CheckStatus::kNotApplicable);  // nothing was promised
  CheckOptions options;
  options.bounds.emplace().max_roughness_degrees = 89;
  report = check_mesh(cube, options);
  EXPECT_EQ(failures(report), Names{"roughness"});
  EXPECT_EQ(report.find("roughness")->violations, 12u);  // the diagonals of its faces are flat
  options.bounds->max_roughness_degrees = 90;
  EXPECT_TRUE(check_mesh(cube, options).all_hold());
  // A regular tetrahedron's dihedral angles are those of cosine 1/3.
  const SurfaceMesh regular = tetrahedron({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1});
  EXPECT_NEAR(check_mesh(regular).find("roughness")->measured, 180 - std::acos(1.0 / 3) * 180 / M_PI, 1e-9);
}

TEST(CheckMesh, RoughnessIsForgivenWhatTheFormatRounds) {
  CheckOptions options;
  options.bounds.emplace().max_roughness_degrees = 89.9999;
  const SurfaceMesh cube = boundary_surface(cube_mesh());
  EXPECT_EQ(failures(cube, options), Names{"roughness"});
  options.coordinate_error = 1e-5;
  EXPECT_EQ(failures(cube, options), Names{});
}

TEST(CheckMesh, TorusHasGenusOne) {
  SurfaceMesh torus;
  constexpr std::uint32_t kN = 12;
  for (std::uint32_t i = 0; i < kN; ++i) {
    for (std::uint32_t j = 0; j < kN; ++j) {
      const double u = 2 * M_PI * i / kN, v = 2 * M_PI * j / kN, r = 3 + std::cos(v);
      torus.points.push_back({r * std::cos(u), r * std::sin(u), std::sin(v)});
      const std::uint32_t a = i * kN + j, b = (i + 1) % kN * kN + j, c = (i + 1) % kN * kN + (j + 1) % kN,
                          d = i * kN + (j + 1) % kN;
      torus.triangles.push_back({a, b, c});
      torus.triangles.push_back({a, c, d});
    }
  }
  const CheckReport report = check_mesh(torus);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  EXPECT_EQ(report.statistics.euler, 0);
  EXPECT_EQ(report.statistics.components.at(0).genus, 1);
}

TEST(CheckMesh, EmptyMeshFails) {
  EXPECT_EQ(failures(SurfaceMesh{}), Names{"not empty"});
  EXPECT_EQ(failures(TetMesh{}), Names{"not empty"});
}

TEST(CheckMesh, InterruptedRunIsNamed) {
  TetMesh mesh = cube_mesh();
  mesh.info.complete = false;
  EXPECT_EQ(failures(mesh), Names{"complete run"});
}

TEST(CheckMesh, NotANumberIsNamed) {
  TetMesh mesh = cube_mesh();
  mesh.points[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(failures(mesh), Names{"finite coordinates"});
}

TEST(CheckMesh, IndexBeyondThePointsIsNamed) {
  TetMesh mesh = cube_mesh();
  mesh.tets[0][1] = 8;
  EXPECT_EQ(failures(mesh), Names{"valid indices"});
  SurfaceMesh surface = icosphere(0);
  surface.triangles[0][2] = 12;
  EXPECT_EQ(failures(surface), Names{"valid indices"});
}

TEST(CheckMesh, FlippedTetIsNotPositive) {
  TetMesh mesh = cube_mesh(2);
  std::swap(mesh.tets[7][0], mesh.tets[7][1]);
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(report.find("positive tets")->violations, 1u);
  EXPECT_EQ(failures(report).count("tets on both sides of a face"), 1u);
}

TEST(CheckMesh, FlatTetIsNotPositive) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.tets = {{0, 1, 2, 3}};
  EXPECT_EQ(failures(mesh).count("positive tets"), 1u);
}

TEST(CheckMesh, RemovedTriangleOpensTheSurface) {
  SurfaceMesh mesh = icosphere(2);
  mesh.triangles.pop_back();
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(failures(report), Names{"closed surface"});
  EXPECT_EQ(report.find("closed surface")->violations, 3u);
  EXPECT_EQ(report.find("outward orientation")->status, CheckStatus::kNotApplicable);
}

TEST(CheckMesh, ExpectedOpenBorderIsNoFault) {
  SurfaceMesh mesh = icosphere(2);
  mesh.triangles.pop_back();
  mesh.info.open_border = true;
  EXPECT_EQ(failures(mesh), Names{});
}

TEST(CheckMesh, DuplicateNodeAndTheCrackItMakesAreNamed) {
  TetMesh mesh = cube_mesh(2);
  // The node in the middle of the cube is doubled: some of its tets come loose from the others.
  const std::uint32_t middle = 13, copy = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back(mesh.points[middle]);
  std::size_t moved = 0;
  for (Tet& tet : mesh.tets) {
    const auto at = std::find(tet.begin(), tet.end(), middle);
    if (at != tet.end() && moved++ % 2 == 0) *at = copy;
  }
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(report.find("no duplicate points")->violations, 1u);
  EXPECT_EQ(failures(report).count("boundary list"), 1u);
}

TEST(CheckMesh, UnmergedHalvesAreACrack) {
  TetMesh mesh = cube_mesh(1), other = cube_mesh(1, 1, {1, 0, 0});
  for (Tet tet : other.tets) {
    for (std::uint32_t& v : tet) v += 8;
    mesh.tets.push_back(tet);
  }
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  mesh.boundary = boundary_of(mesh.tets);
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(failures(report).count("no duplicate points"), 1u) << to_text(report);
  EXPECT_EQ(report.find("no duplicate points")->violations, 4u);
  EXPECT_EQ(report.statistics.tet_components, 2u);
}

TEST(CheckMesh, NodesThatTheFormatCannotTellApartAreNamed) {
  SurfaceMesh mesh = icosphere(1, 100, {1000, 0, 0});
  append(mesh, icosphere(1, 100, {1000, 0, 1e-5}));
  EXPECT_EQ(check_mesh(mesh).find("no duplicate points")->violations, 0u);
  CheckOptions single;
  single.coordinate_error = 6e-8;
  EXPECT_EQ(check_mesh(mesh, single).find("points apart at the format's precision")->violations, 42u);
}

TEST(CheckMesh, OrphanNodeIsNamed) {
  TetMesh mesh = cube_mesh();
  mesh.points.push_back({5, 5, 5});
  EXPECT_EQ(failures(mesh), Names{"no orphan points"});
  SurfaceMesh surface = icosphere(1);
  surface.points.push_back({5, 5, 5});
  EXPECT_EQ(failures(surface), Names{"no orphan points"});
}

TEST(CheckMesh, TetsSharingOnlyAnEdgeAreNotManifold) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  mesh.tets = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(failures(report), Names{"manifold edges"}) << to_text(report);
  EXPECT_EQ(report.find("manifold edges")->violations, 1u);
}

TEST(CheckMesh, ConesTouchingAtAVertexAreNotManifold) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {-1, -1, 1}, {1, 0, -1}, {0, 1, -1}, {-1, -1, -1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 4, 6, 5}};
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(failures(report), Names{"manifold vertices"}) << to_text(report);
  EXPECT_EQ(report.statistics.surface_components, 2u);
}

TEST(CheckMesh, DuplicateTetIsNamed) {
  TetMesh mesh = cube_mesh();
  mesh.tets.push_back(mesh.tets[2]);
  const Names names = failures(mesh);
  EXPECT_EQ(names.count("no duplicate tets"), 1u);
  EXPECT_EQ(names.count("faces in one or two tets"), 1u);
}

TEST(CheckMesh, BoundaryListMustBeTheBoundary) {
  TetMesh missing = cube_mesh();
  missing.boundary.pop_back();
  EXPECT_EQ(failures(missing), Names{"boundary list"});
  TetMesh turned = cube_mesh();
  std::swap(turned.boundary[0][0], turned.boundary[0][1]);
  EXPECT_EQ(failures(turned), Names{"boundary list"});
  TetMesh surplus = cube_mesh();
  surplus.boundary.push_back({0, 7, 1});  // a face inside
  EXPECT_EQ(failures(surplus), Names{"boundary list"});
}

TEST(CheckMesh, InterfaceBetweenRegionsMayBeListed) {
  TetMesh mesh = cube_mesh();
  mesh.regions.assign(mesh.tets.size(), 1);
  mesh.regions[0] = 2;
  const Tet& t = mesh.tets[0];
  for (const auto& f : kTetFaces) {
    const Triangle face{t[f[0]], t[f[1]], t[f[2]]};
    const bool is_boundary = std::find(mesh.boundary.begin(), mesh.boundary.end(), face) != mesh.boundary.end();
    if (!is_boundary) mesh.boundary.push_back(face);
  }
  EXPECT_EQ(failures(mesh), Names{});
}

TEST(CheckMesh, DuplicateTriangleIsNamed) {
  SurfaceMesh mesh = icosphere(1);
  mesh.triangles.push_back(mesh.triangles[5]);
  EXPECT_EQ(failures(mesh).count("no duplicate triangles"), 1u);
  SurfaceMesh pillow;
  pillow.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  pillow.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(failures(pillow).count("no duplicate triangles"), 1u);
}

TEST(CheckMesh, TriangleWithoutAreaIsDegenerate) {
  EXPECT_EQ(failures(tetrahedron({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1})).count("no degenerate triangles"), 1u);
  SurfaceMesh repeated = icosphere(1);
  repeated.triangles[0][1] = repeated.triangles[0][0];
  EXPECT_EQ(failures(repeated).count("no degenerate triangles"), 1u);
}

TEST(CheckMesh, TurnedTriangleIsInconsistent) {
  SurfaceMesh mesh = icosphere(2);
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(failures(report), Names{"consistent orientation"});
  EXPECT_EQ(report.find("consistent orientation")->violations, 3u);
}

TEST(CheckMesh, InvertedSurfaceIsNotOutward) {
  EXPECT_EQ(failures(inverted(icosphere(2))), Names{"outward orientation"});
}

TEST(CheckMesh, ShellsMustAlternate) {
  SurfaceMesh shells = icosphere(2, 3);
  append(shells, inverted(icosphere(2, 2, {0.1, 0.2, 0.3})));
  append(shells, icosphere(1, 1, {0.1, 0.2, 0.3}));
  append(shells, icosphere(1, 1, {9, 0, 0}));
  const CheckReport report = check_mesh(shells);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  EXPECT_EQ(report.statistics.surface_components, 4u);
  EXPECT_EQ(report.statistics.cavities, 1u);

  SurfaceMesh filled = icosphere(2, 3);
  append(filled, icosphere(2, 2));
  EXPECT_EQ(failures(filled), Names{"outward orientation"});
  SurfaceMesh hollow_twice = icosphere(2, 1);
  append(hollow_twice, inverted(icosphere(2, 1, {4, 0, 0})));
  EXPECT_EQ(failures(hollow_twice), Names{"outward orientation"});
}

TEST(CheckMesh, CrossingSheetsAreNamed) {
  SurfaceMesh overlapping = icosphere(2);
  append(overlapping, icosphere(2, 1, {1.1, 0.2, 0.1}));
  EXPECT_EQ(failures(overlapping).count("no crossing triangles"), 1u);
  SurfaceMesh apart = icosphere(2);
  append(apart, icosphere(2, 1, {2.1, 0.2, 0.1}));
  EXPECT_EQ(failures(apart), Names{});
  // A single node pulled through the opposite wall.
  SurfaceMesh poked = icosphere(3);
  poked.points[0] = -1.5 * poked.points[0];
  EXPECT_EQ(failures(poked).count("no crossing triangles"), 1u);
}

TEST(CheckMesh, TriangleFoldedOntoItsNeighbourCrossesIt) {
  SurfaceMesh folded;
  folded.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}};
  folded.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(failures(folded).count("no crossing triangles"), 1u);
  folded.points[3] = {0.3, -0.3, 0};
  EXPECT_EQ(failures(folded).count("no crossing triangles"), 0u);
}

TEST(CheckMesh, OverlappingTetsWithAGoodBoundaryEachAreNamed) {
  TetMesh mesh = cube_mesh(2), other = cube_mesh(2, 1, {0.5, 0.6, 0.7});
  for (Tet tet : other.tets) {
    for (std::uint32_t& v : tet) v += 27;
    mesh.tets.push_back(tet);
  }
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  mesh.boundary = boundary_of(mesh.tets);
  EXPECT_EQ(failures(mesh).count("no crossing triangles"), 1u);
}

TEST(CheckMesh, SliverBreaksTheDihedralBound) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0.01}, {1, 1, 0}, {0, 1, 0.01}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.info.promises.min_dihedral_degrees = 5;
  mesh.info.promises.radius_edge = 2;
  const CheckReport report = check_mesh(mesh);
  EXPECT_EQ(failures(report), Names{"dihedral"}) << to_text(report);
  EXPECT_LT(report.find("dihedral")->measured, 2);
}

TEST(CheckMesh, EachNumericBoundIsHeldToTheMesh) {
  TetMesh mesh = cube_mesh(2);
  const auto with = [&](auto member, double value) {
    CheckOptions options;
    options.bounds = Promises{};
    (*options.bounds).*member = value;
    return failures(mesh, options);
  };
  EXPECT_EQ(with(&Promises::min_angle_degrees, 44.9), Names{});
  EXPECT_EQ(with(&Promises::min_angle_degrees, 45.1), Names{"angle"});
  EXPECT_EQ(with(&Promises::radius_edge, 0.87), Names{});
  EXPECT_EQ(with(&Promises::radius_edge, 0.86), Names{"radius-edge"});
  EXPECT_EQ(with(&Promises::size, 0.71), Names{});
  EXPECT_EQ(with(&Promises::size, 0.70), Names{"size"});
  EXPECT_EQ(with(&Promises::cell_size, 0.87), Names{});
  EXPECT_EQ(with(&Promises::cell_size, 0.86), Names{"cell size"});
  EXPECT_EQ(with(&Promises::min_dihedral_degrees, 44.9), Names{});
  EXPECT_EQ(with(&Promises::min_dihedral_degrees, 45.1), Names{"dihedral"});
}

// Cubes of edge 1 in five layers, tets of circumradius 0.87, triangles of 0.71.
TEST(CheckMesh, CircumradiiMayGrowWithDepthAsTheGradeSaysAndNoFaster) {
  const TetMesh mesh = cube_mesh(5);
  const auto with = [&](double size, double grade) {
    CheckOptions options;
    options.bounds = Promises{};
    options.bounds->size = size;
    options.bounds->grade = grade;
    return check_mesh(mesh, options);
  };
  EXPECT_EQ(failures(with(0.71, 0.2)), Names{});
  const CheckReport broken = with(0.71, 0.1);  // 0.71 * 1.05 + 0.1 * 0.87 at the surface
  EXPECT_EQ(failures(broken), Names{"graded cell size"});
  const Check& check = *broken.find("graded cell size");
  EXPECT_NEAR(check.measured, std::sqrt(0.75) / (0.71 * 1.05 + 0.1 * std::sqrt(0.75)), 1e-9);
  EXPECT_GT(check.violations, 100u);
  EXPECT_LT(check.violations, mesh.tets.size());  // deep inside the bound is larger
}

TEST(CheckMesh, CoordinateErrorOfTheFormatIsForgivenAndNoMore) {
  // An equilateral triangle's angle just misses 60 once its coordinates are rounded to single precision.
  SurfaceMesh mesh = tetrahedron({100, 0, 0}, {101, 0, 0}, {100.5, std::sqrt(0.75), 0}, {100.5, 0.3, 0.8});
  for (Point3& p : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(p[axis]);
  }
  CheckOptions options;
  options.bounds = Promises{};
  const double angle = check_mesh(mesh, options).find("angle")->measured;
  options.bounds->min_angle_degrees = angle + 1e-4;
  EXPECT_EQ(failures(mesh, options), Names{"angle"});
  options.coordinate_error = 6e-8;
  EXPECT_EQ(failures(mesh, options), Names{});
  options.bounds->min_angle_degrees = angle + 1e-2;
  EXPECT_EQ(failures(mesh, options), Names{"angle"});
}

TEST(CheckMesh, TextNamesEveryCheckAndTheVerdict) {
  SurfaceMesh mesh = icosphere(1);
  const CheckReport good = check_mesh(mesh);
  for (const Check& check : good.checks) EXPECT_NE(to_text(good).find(check.name), std::string::npos);
  EXPECT_NE(to_text(good).find("every check holds\n"), std::string::npos);
  mesh.triangles.pop_back();
  EXPECT_NE(to_text(check_mesh(mesh)).find("NOT every check holds"), std::string::npos);
  EXPECT_NE(to_text(check_mesh(mesh)).find("FAILED  closed surface"), std::string::npos);
}

}  // namespace
}  // namespace delvox
