#include "oracle/polygon_surface.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "delvox/core/errors.h"
#include "support/random.h"
#include "support/test_meshes.h"

namespace delvox {
namespace {

SurfaceMesh cube(double h = 1, Point3 origin = {}) { return boundary_surface(test::cube_mesh(1, h, origin)); }

double six_volumes(const PolygonSurface& s) {
  double sum = 0;
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    sum += dot(s.corner(t, 0), cross(s.corner(t, 1), s.corner(t, 2)));
  }
  return sum;
}

/// Refused with an error that says all of this.
void expect_refused(const SurfaceMesh& mesh, const std::vector<std::string>& words) {
  try {
    sound_surface(mesh);
    ADD_FAILURE() << "accepted, against " << words[0];
  } catch (const InputError& error) {
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
    }
  }
}

TEST(PolygonSurface, TurnsEachComponentTheSameWayWhicheverWayItsTrianglesCome) {
  SurfaceMesh mesh = test::inverted(cube());
  test::append(mesh, cube(0.5, {5, 0, 0}));
  test::Random random(3);
  for (Triangle& t : mesh.triangles) {
    if (random.unit() < 0.5) std::swap(t[0], t[2]);
  }
  const PolygonSurface surface = sound_surface(mesh);
  EXPECT_EQ(surface.components, 2u);
  EXPECT_NEAR(six_volumes(surface), 6 * (1 + 0.125), 1e-12);
}

TEST(PolygonSurface, TakesEqualPointsForOneAndLeavesUnusedPointsOut) {
  const SurfaceMesh whole = cube();
  SurfaceMesh soup;
  soup.points.push_back({9, 9, 9});
  for (const Triangle& t : whole.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.points.size());
    for (std::uint32_t v : t) soup.points.push_back(whole.points[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  const PolygonSurface surface = sound_surface(soup);
  EXPECT_EQ(surface.points.size(), 8u);
  EXPECT_EQ(surface.triangles.size(), 12u);
}

TEST(PolygonSurface, RefusesAnOpenSurfaceAndSaysWhere) {
  SurfaceMesh mesh = cube();
  mesh.triangles.pop_back();
  expect_refused(mesh, {"open", "3 edges", "the first at "});
  expect_refused({}, {"no triangles"});
}

TEST(PolygonSurface, RefusesEdgesOfFourTrianglesAndPinchedVertices) {
  SurfaceMesh at_edge = cube();
  test::append(at_edge, cube(1, {1, 1, 0}));
  expect_refused(at_edge, {"not manifold", "share the edge at 1, 1, 0.5"});
  SurfaceMesh at_vertex = cube();
  test::append(at_vertex, cube(1, {1, 1, 1}));
  expect_refused(at_vertex, {"not manifold", "touch in the vertex at 1, 1, 1"});
}

TEST(PolygonSurface, RefusesTheProjectivePlane) {
  // Six points, ten triangles, each edge in two of them.
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {3, 0, 0}, {0, 3, 1}, {1, 0, 4}, {2, 5, 2}, {4, 1, 3}};
  mesh.triangles = {{0, 1, 4}, {0, 1, 5}, {0, 2, 3}, {0, 2, 5}, {0, 3, 4},
                    {1, 2, 3}, {1, 2, 4}, {1, 3, 5}, {2, 4, 5}, {3, 4, 5}};
  expect_refused(mesh, {"not orientable", "triangles"});
}

TEST(PolygonSurface, RefusesASurfaceThatCrossesItselfAndNamesTheTriangles) {
  SurfaceMesh mesh = cube();
  test::append(mesh, cube(1, {0.5, 0.25, 0.125}));
  expect_refused(mesh, {"crosses itself", "triangles ", "meet near ", "more pairs"});
  // Touching is crossing too: a face on a face, and a corner in the middle of a face.
  SurfaceMesh touching = cube();
  test::append(touching, cube(0.5, {0.25, 0.25, 1}));
  expect_refused(touching, {"crosses itself"});
}

TEST(PolygonSurface, RefusesFacesFoldedOntoEachOther) {
  // A flat pillow: two triangles with the same corners.
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  expect_refused(mesh, {"crosses itself", "triangles 0 and 1"});
}

TEST(PolygonSurface, RefusesATriangleWithoutAreaByItsNumberInTheFile) {
  // The edge from corner 0 to 1 of a tetrahedron, with a vertex on it for one side only; the first triangle collapses.
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}};
  mesh.triangles = {{4, 4, 1}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}, {0, 2, 1}, {1, 2, 3}, {0, 3, 2}};
  expect_refused(mesh, {"triangle 3 ", "no area"});
}

TEST(PolygonSurface, RefusesCoordinatesThatCannotBeComputedWith) {
  SurfaceMesh huge = cube(1e300), tiny = cube(1e-200), endless = cube();
  endless.points[0].x = Box3::kInfinity;
  expect_refused(huge, {"no size to compute with"});
  expect_refused(tiny, {"no size to compute with"});
  expect_refused(endless, {"not finite"});
  huge.triangles[0][0] = 99;
  expect_refused(huge, {"triangle 0 names a point that is not there"});
}

TEST(PolygonSurface, NestedShellsAndShellsSideBySideAreSound) {
  SurfaceMesh mesh = cube(4);
  test::append(mesh, test::icosphere(2, 1, {2, 2, 2}));
  test::append(mesh, cube(1, {4.001, 0, 0}));
  EXPECT_EQ(sound_surface(mesh).components, 3u);
}

}  // namespace
}  // namespace delvox
