#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <vector>

#include "delvox/core/mesh.h"

// Plain measurements of surfaces, written anew for tests: they share no code with the mesher or with check_mesh.

namespace delvox::test {

struct SurfaceTopology {
  std::size_t components = 0;  ///< of triangles joined at vertices
  long euler = 0;
  std::size_t open_or_crowded_edges = 0;  ///< not in exactly two triangles, once in each direction
  std::size_t singular_vertices = 0;      ///< whose triangles do not form one fan
  std::size_t unused_points = 0;
};

namespace detail {

struct UnionFind {
  explicit UnionFind(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), std::size_t{0}); }
  std::size_t root(std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent[root(a)] = root(b); }
  std::vector<std::size_t> parent;
};

}  // namespace detail

inline SurfaceTopology topology_of(const SurfaceMesh& mesh) {
  SurfaceTopology result;
  // Half-edges; and corners of triangles, joined where two triangles share an edge at a vertex: one fan, one class.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> half_edges;
  detail::UnionFind vertices(mesh.points.size()), corners(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      half_edges[{a, b}].push_back(3 * t + i);
      vertices.join(a, b);
    }
  }
  std::size_t edges = 0;
  for (const auto& [edge, own] : half_edges) {
    const auto back = half_edges.find({edge.second, edge.first});
    const bool paired = own.size() == 1 && back != half_edges.end() && back->second.size() == 1;
    if (paired && edge.second < edge.first) continue;  // counted from its other side
    ++edges;
    if (!paired) {
      ++result.open_or_crowded_edges;
      continue;
    }
    const std::size_t here = own[0], there = back->second[0];
    const auto next = [](std::size_t corner) { return corner - corner % 3 + (corner + 1) % 3; };
    corners.join(here, next(there));
    corners.join(next(here), there);
  }
  std::vector<std::size_t> fans(mesh.points.size(), 0);
  for (std::size_t c = 0; c < corners.parent.size(); ++c) {
    if (corners.root(c) == c) ++fans[mesh.triangles[c / 3][c % 3]];
  }
  std::size_t used = 0;
  for (std::size_t v = 0; v < fans.size(); ++v) {
    used += fans[v] > 0;
    result.singular_vertices += fans[v] > 1;
    result.components += fans[v] > 0 && vertices.root(v) == v;
  }
  result.unused_points = fans.size() - used;
  result.euler = static_cast<long>(used) - static_cast<long>(edges) + static_cast<long>(mesh.triangles.size());
  return result;
}

/// Volume enclosed by an outward oriented closed surface.
inline double enclosed_volume(const SurfaceMesh& mesh) {
  double six_volumes = 0;
  for (const Triangle& t : mesh.triangles) {
    six_volumes += dot(mesh.points[t[0]], cross(mesh.points[t[1]], mesh.points[t[2]]));
  }
  return six_volumes / 6;
}

inline double area_of(const SurfaceMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Point3& a = mesh.points[t[0]];
    area += 0.5 * norm(cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a));
  }
  return area;
}

inline double smallest_angle_degrees(const Point3& a, const Point3& b, const Point3& c) {
  const auto angle = [](const Point3& at, const Point3& p, const Point3& q) {
    return std::atan2(norm(cross(p - at, q - at)), dot(p - at, q - at)) * 180 / 3.14159265358979323846;
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

/// pi less the dihedral angle, at each edge of two triangles.
inline std::vector<double> roughnesses_degrees(const SurfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vector3> normals;  // of the triangle to the left of each half-edge
  for (const Triangle& t : mesh.triangles) {
    const Vector3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    for (std::size_t i = 0; i < 3; ++i) normals[{t[i], t[(i + 1) % 3]}] = n;
  }
  std::vector<double> result;
  for (const auto& [edge, n] : normals) {
    const auto back = normals.find({edge.second, edge.first});
    if (edge.first > edge.second || back == normals.end()) continue;
    const double cosine = dot(n, back->second) / (norm(n) * norm(back->second));
    result.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / 3.14159265358979323846);
  }
  return result;
}

inline double largest_roughness_degrees(const SurfaceMesh& mesh) {
  const std::vector<double> all = roughnesses_degrees(mesh);
  return *std::max_element(all.begin(), all.end());
}

inline std::size_t rougher_edges(const SurfaceMesh& mesh, double degrees) {
  const std::vector<double> all = roughnesses_degrees(mesh);
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](double r) { return r > degrees; }));
}

/// In the triangle's plane.
inline Point3 circumcenter(const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 u = b - a, v = c - a, n = cross(u, v);
  return a + (0.5 / squared_norm(n)) * (squared_norm(u) * cross(v, n) + squared_norm(v) * cross(n, u));
}

/// Points spread over a triangle, its corners and edges among them.
template <class Visit>
void for_each_sample(const SurfaceMesh& mesh, int per_edge, const Visit& visit) {
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i <= per_edge; ++i) {
      for (int j = 0; i + j <= per_edge; ++j) {
        const double u = static_cast<double>(i) / per_edge, v = static_cast<double>(j) / per_edge;
        visit(u * mesh.points[t[0]] + v * mesh.points[t[1]] + (1 - u - v) * mesh.points[t[2]]);
      }
    }
  }
}

/// Closed, two triangles at each edge in opposite directions, one fan at each vertex, no unused point.
inline void expect_closed_manifold(const SurfaceMesh& mesh) {
  EXPECT_FALSE(mesh.triangles.empty());
  const SurfaceTopology topology = topology_of(mesh);
  EXPECT_EQ(topology.open_or_crowded_edges, 0u);
  EXPECT_EQ(topology.singular_vertices, 0u);
  EXPECT_EQ(topology.unused_points, 0u);
}

}  // namespace delvox::test
