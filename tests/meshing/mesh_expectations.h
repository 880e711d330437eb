#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "delvox/check/check_mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/oracle/oracle.h"
#include "support/surface_measures.h"

namespace delvox::test {

/// The promises of a mesh, by check_mesh.
inline void expect_all_checks_hold(const Mesh& mesh) {
  CheckOptions options;
  options.level = CheckLevel::kCheap;
  const CheckReport report = check_mesh(mesh, options);
  EXPECT_TRUE(report.all_hold()) << to_text(report);
}

inline void expect_on_surface(const SmoothOracle& oracle, const Point3& p, double voxel) {
  EXPECT_LE(std::abs(oracle.value(p)), 1e-6 * voxel * norm(oracle.gradient(p)));
}

/// Angles of at least 30 degrees, circumradii of at most `size`.
inline void expect_good_triangles(const SurfaceMesh& mesh, double size) {
  double angle = 60, radius = 0;
  for (const Triangle& t : mesh.triangles) {
    const Point3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    angle = std::min(angle, smallest_angle_degrees(a, b, c));
    radius = std::max(radius, distance(circumcenter(a, b, c), a));
  }
  EXPECT_GE(angle, 30 - 1e-9);
  EXPECT_LE(radius, size * (1 + 1e-9));
}

struct TetShape {
  double volume, circumradius, shortest_edge;
  Point3 circumcenter;
};

inline TetShape shape_of(const TetMesh& mesh, const Tet& tet) {
  const Point3& a = mesh.points[tet[0]];
  const Vector3 u = mesh.points[tet[1]] - a, v = mesh.points[tet[2]] - a, w = mesh.points[tet[3]] - a;
  const double six_volumes = dot(cross(u, v), w);
  const Vector3 offset = (0.5 / six_volumes) * (squared_norm(u) * cross(v, w) + squared_norm(v) * cross(w, u) +
                                                squared_norm(w) * cross(u, v));
  double shortest = Box3::kInfinity;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) shortest = std::min(shortest, distance(mesh.points[tet[i]], mesh.points[tet[j]]));
  }
  return {six_volumes / 6, norm(offset), shortest, a + offset};
}

/// Positive tets within their bounds, no orphan, the boundary listed is the boundary, and its volume that of the tets.
inline void expect_good_tets(const TetMesh& mesh, double cell_size) {
  std::size_t not_positive = 0;
  double radius_edge = 0, radius = 0, volume = 0;
  std::vector<char> used(mesh.points.size(), 0);
  for (const Tet& tet : mesh.tets) {
    const TetShape shape = shape_of(mesh, tet);
    not_positive += !(shape.volume > 0);
    volume += shape.volume;
    // Circumradii of slivers as flat as these are good to a few digits less than nine.
    radius_edge = std::max(radius_edge, shape.circumradius / shape.shortest_edge);
    radius = std::max(radius, shape.circumradius);
    for (std::uint32_t v : tet) used[v] = 1;
  }
  EXPECT_EQ(not_positive, 0u);
  EXPECT_LE(radius_edge, 2 * (1 + 1e-7));
  EXPECT_LE(radius, cell_size * (1 + 1e-7));
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
  const auto canonical = [](std::vector<Triangle> triangles) {
    for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  EXPECT_EQ(canonical(mesh.boundary), canonical(boundary_of(mesh.tets)));
  EXPECT_NEAR(enclosed_volume(boundary_surface(mesh)) / volume, 1, 1e-9);
}

/// Boundary nodes on the isosurface and said to be; the others inside and not, or on a sheet too small to be meshed.
inline void expect_good_nodes(const TetMesh& mesh, const SmoothOracle& oracle, double voxel) {
  std::vector<std::uint8_t> on_boundary(mesh.points.size(), 0);
  for (const Triangle& t : mesh.boundary) {
    for (std::uint32_t v : t) on_boundary[v] = 1;
  }
  EXPECT_EQ(mesh.on_surface, on_boundary);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (on_boundary[v]) {
      expect_on_surface(oracle, mesh.points[v], voxel);
    } else {
      EXPECT_GE(oracle.value(mesh.points[v]), -1e-9);
    }
  }
}

/// No limit, no broken promise; criteria that are counted only do not matter.
inline void expect_finished(const RunReport& report) {
  EXPECT_EQ(report.stop, StopReason::kFinished);
  for (const Unmet& unmet : report.unmet) {
    if (!unmet.breaks_promise) continue;
    std::string place;
    if (const auto& p = unmet.where) {
      place = " at (" + std::to_string(p->x) + ", " + std::to_string(p->y) + ", " + std::to_string(p->z) + ")";
    }
    ADD_FAILURE() << unmet.criterion << ": " << unmet.count << place << ": " << unmet.reason;
  }
}

/// What delsurf makes of it, once that is found to be a closed manifold of that Euler number.
inline SurfaceMesh closed_surface(const Oracle& oracle, const SurfaceCriteria& criteria, long euler,
                                  RunReport& report) {
  DelSurfOptions options;
  options.surface = criteria;
  SurfaceMesh mesh = delsurf(oracle, options, report);
  expect_finished(report);
  expect_closed_manifold(mesh);
  EXPECT_EQ(topology_of(mesh).euler, euler);
  return mesh;
}

}  // namespace delvox::test
