#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/test_meshes.h"

// Closed surfaces with sharp edges, outward.

namespace delvox::test {

/// A prism over a convex polygon in the plane z = 0, corners counter-clockwise.
inline SurfaceMesh prism(const std::vector<Point3>& polygon, double height) {
  const auto n = static_cast<std::uint32_t>(polygon.size());
  SurfaceMesh mesh;
  mesh.points = polygon;
  for (const Point3& p : polygon) mesh.points.push_back({p.x, p.y, height});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
    if (i < 2) continue;
    mesh.triangles.push_back({i, i - 1, 0});
    mesh.triangles.push_back({n, n + i - 1, n + i});
  }
  return mesh;
}

/// With so many flat sides, about the z axis.
inline SurfaceMesh polygonal_cylinder(int sides, double radius, double height) {
  std::vector<Point3> polygon;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return prism(polygon, height);
}

/// Its dihedral angle at the z axis is so large; two sides of length 10, height 8.
inline SurfaceMesh wedge(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return prism({{0, 0, 0}, {10, 0, 0}, {10 * std::cos(angle), 10 * std::sin(angle), 0}}, 8);
}

/// Over a square of 10, its sides rising at so many degrees.
inline SurfaceMesh pyramid(double degrees) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 5, 5 * std::tan(degrees * std::numbers::pi / 180)}};
  mesh.triangles = {{2, 1, 0}, {3, 2, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return mesh;
}

/// A cube of 10 in 4 x 4 x 4 parts, but for a slot of 2.5 x 5 along y in the middle of its top.
inline SurfaceMesh notched_cube() {
  TetMesh cube = cube_mesh(4, 2.5);
  std::erase_if(cube.tets, [&](const Tet& t) {
    const Point3 c = 0.25 * ((cube.points[t[0]] + cube.points[t[1]]) + (cube.points[t[2]] + cube.points[t[3]]));
    return c.x > 2.5 && c.x < 5 && c.z > 5;
  });
  cube.boundary = boundary_of(cube.tets);
  return boundary_surface(cube);
}

}  // namespace delvox::test
