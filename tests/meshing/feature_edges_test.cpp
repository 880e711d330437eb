// Sharp edges of polygon surfaces are kept: what is promised of them, and that all else that is promised still holds.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "delvox/core/sharp_edges.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/meshing/remove_slivers.h"
#include "delvox/oracle/formula.h"
#include "delvox/core/errors.h"
#include "delvox/oracle/polygon_oracle.h"
#include "meshing/mesh_expectations.h"
#include "support/sharp_shapes.h"

namespace delvox::test {
namespace {

SurfaceCriteria criteria(double size, double degrees) {
  SurfaceCriteria result;
  result.size = size;
  result.min_ball_radius = 0.001 * size;
  result.thin_ball_radius = 0.25 * size;
  result.feature_angle_degrees = degrees;
  return result;
}

SurfaceMesh remeshed(const SurfaceMesh& shape, double size, double degrees) {
  RunReport report;
  SurfaceMesh mesh = delsurf(*make_polygon_oracle(shape), {criteria(size, degrees), {}, {}}, report);
  expect_finished(report);
  return mesh;
}

TetMesh filled(const SurfaceMesh& shape, double size, double degrees) {
  RunReport report;
  const auto oracle = make_polygon_oracle(shape);
  const SurfaceCriteria surface = criteria(size, degrees);
  const TetCriteria tets{2, size};
  TetMesh mesh = deltetsurf(*oracle, {surface, tets, {}, {}, min_fold_for(15)}, report);
  remove_slivers(mesh, *oracle, {15, surface, tets, {}}, report);
  expect_finished(report);
  return mesh;
}

/// Do edges of the mesh, end to end, make up the segment ab?
bool follows(const SurfaceMesh& mesh, const std::map<std::uint32_t, std::set<std::uint32_t>>& neighbors, const Point3& a,
             const Point3& b) {
  std::uint32_t at = 0;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (distance(mesh.points[v], a) < distance(mesh.points[at], a)) at = v;
  }
  if (distance(mesh.points[at], a) > 1e-9) return false;
  const double length = distance(a, b);
  for (double reached = 0; reached < length - 1e-9;) {
    bool any = false;
    for (std::uint32_t next : neighbors.at(at)) {
      const double along = dot(mesh.points[next] - a, b - a) / length;
      const Point3 there = a + (along / length) * (b - a);
      if (along <= reached + 1e-9 || along > length + 1e-9 || distance(there, mesh.points[next]) > 1e-9) continue;
      at = next;
      reached = along;
      any = true;
      break;
    }
    if (!any) return false;
  }
  return true;
}

/// Every sharp edge of the shape, whose corners are all corners of the mesh. pre: no sharp edges in one line.
void expect_kept(const SurfaceMesh& mesh, const SurfaceMesh& shape, double degrees) {
  std::map<std::uint32_t, std::set<std::uint32_t>> neighbors;
  for (const Triangle& t : mesh.triangles) {
    for (std::uint32_t v : t) neighbors[v].insert(t.begin(), t.end());
  }
  const std::vector<SharpEdge> sharp = sharp_edges(shape.points, shape.triangles, degrees);
  EXPECT_FALSE(sharp.empty());
  for (const SharpEdge& edge : sharp) {
    const Point3 &a = shape.points[edge.ends[0]], &b = shape.points[edge.ends[1]];
    EXPECT_TRUE(follows(mesh, neighbors, a, b)) << a.x << " " << a.y << " " << a.z << " to " << b.x << " " << b.y << " " << b.z;
  }
}

void expect_checks_hold(const Mesh& mesh, const SurfaceMesh& shape, double degrees) {
  CheckOptions options;
  options.surface = &shape;
  options.feature_angle_degrees = degrees;
  options.require_same_topology = true;
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
  ASSERT_TRUE(report.feature_comparison);
  EXPECT_EQ(report.feature_comparison->missing_mm, 0);
  EXPECT_GT(report.feature_comparison->kept_edges, 0u);
}

/// Triangles with no corner on a sharp edge have angles of 30 degrees; all are small enough.
void expect_bounds_away_from_edges(const SurfaceMesh& mesh, double size) {
  std::vector<bool> on_edge(mesh.points.size(), false);
  for (const Edge& edge : mesh.features) {
    for (std::uint32_t v : edge) on_edge[v] = true;
  }
  for (const Triangle& t : mesh.triangles) {
    const Point3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    EXPECT_LE(distance(circumcenter(a, b, c), a), size * (1 + 1e-9));
    if (on_edge[t[0]] || on_edge[t[1]] || on_edge[t[2]]) continue;
    EXPECT_GE(smallest_angle_degrees(a, b, c), 30 - 1e-9);
  }
}

struct Case {
  const char* name;
  SurfaceMesh shape;
  double size, degrees;
};

std::vector<Case> cases() {
  return {{"cube", boundary_surface(cube_mesh(1, 10)), 1.3, 60},
          {"notch", notched_cube(), 1, 60},
          {"cylinder", polygonal_cylinder(36, 5, 10), 1, 60},
          {"wedge", wedge(20), 1, 60},
          {"pyramid", pyramid(20), 1, 20},
          {"icosahedron", icosphere(0, 10), 1.5, 40}};
}

class KeepsEdges : public ::testing::TestWithParam<std::size_t> {};

TEST_P(KeepsEdges, InSurfaceMeshes) {
  const Case c = cases()[GetParam()];
  SCOPED_TRACE(c.name);
  const SurfaceMesh mesh = remeshed(c.shape, c.size, c.degrees);
  expect_closed_manifold(mesh);
  expect_kept(mesh, c.shape, c.degrees);
  expect_checks_hold(mesh, c.shape, c.degrees);
  expect_bounds_away_from_edges(mesh, c.size);
}

TEST_P(KeepsEdges, InTetMeshes) {
  const Case c = cases()[GetParam()];
  SCOPED_TRACE(c.name);
  const TetMesh mesh = filled(c.shape, c.size, c.degrees);
  const SurfaceMesh boundary = boundary_surface(mesh);
  expect_closed_manifold(boundary);
  expect_kept(boundary, c.shape, c.degrees);
  expect_checks_hold(mesh, c.shape, c.degrees);
}

INSTANTIATE_TEST_SUITE_P(FeatureEdges, KeepsEdges, ::testing::Range<std::size_t>(0, 6));

TEST(FeatureEdges, FlatSidesComeOutWithTheirVolume) {
  for (const SurfaceMesh& shape : {boundary_surface(cube_mesh(1, 10)), notched_cube(), wedge(20), pyramid(20)}) {
    const double volume = enclosed_volume(shape);
    EXPECT_NEAR(enclosed_volume(remeshed(shape, 1, 20)) / volume, 1, 1e-9);
    EXPECT_NEAR(enclosed_volume(boundary_surface(filled(shape, 1, 20))) / volume, 1, 1e-9);
  }
}

TEST(FeatureEdges, WithoutThemCornersAreCut) {
  const SurfaceMesh cube = boundary_surface(cube_mesh(1, 10));
  EXPECT_LT(enclosed_volume(remeshed(cube, 1.3, 180)), 1000 - 1e-3);
}

TEST(FeatureEdges, AnglesAboveThatOfTheSurfaceKeepNone) {
  const SurfaceMesh mesh = remeshed(icosphere(0, 10), 1.5, 42);
  EXPECT_TRUE(mesh.features.empty());
  const SurfaceMesh plain = remeshed(icosphere(0, 10), 1.5, 180);
  EXPECT_EQ(mesh.points, plain.points);
  EXPECT_EQ(mesh.triangles, plain.triangles);
}

TEST(FeatureEdges, AComponentWithoutAnyInTheBallsOfAnothersEdgesIsMeshedAsWell) {
  SurfaceMesh both = boundary_surface(cube_mesh(1, 10));
  append(both, icosphere(2, 0.3, {5, -0.4, -0.1}));
  const SurfaceMesh mesh = remeshed(both, 1.5, 60);
  expect_closed_manifold(mesh);
  EXPECT_EQ(topology_of(mesh).components, 2u);
  expect_kept(mesh, both, 60);
}

TEST(FeatureEdges, SurfacesWithoutFacetsHaveNone) {
  RunReport report;
  const auto sphere = make_formula_oracle(Formula("x^2 + y^2 + z^2 - 1"), {{-2, -2, -2}, {2, 2, 2}}, 0.1);
  EXPECT_THROW(delsurf(*sphere, {criteria(0.2, 60), {}, {}}, report), OptionError);
  const auto cube = make_polygon_oracle(boundary_surface(cube_mesh(1, 10)));
  EXPECT_THROW(delsurf(*cube, {criteria(1, 0), {}, {}}, report), OptionError);
  EXPECT_THROW(delsurf(*cube, {criteria(1, 181), {}, {}}, report), OptionError);
}

}  // namespace
}  // namespace delvox::test
