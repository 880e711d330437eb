#pragma once

#include <cmath>
#include <cstdint>
#include <map>

#include "delvox/core/mesh.h"

namespace delvox::test {

/// n x n x n cubes of edge h, six tets each around the main diagonal (Kuhn): conforming, all positive.
inline TetMesh cube_mesh(int n = 1, double h = 1, Point3 origin = {}) {
  static constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  TetMesh mesh;
  const auto index = [n](int i, int j, int k) { return static_cast<std::uint32_t>((k * (n + 1) + j) * (n + 1) + i); };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) mesh.points.push_back(origin + Point3{h * i, h * j, h * k});
    }
  }
  for (int cell = 0; cell < n * n * n; ++cell) {
    const int corner[3] = {cell % n, cell / n % n, cell / n / n};
    for (int o = 0; o < 6; ++o) {
      int at[3] = {corner[0], corner[1], corner[2]};
      Tet tet{index(at[0], at[1], at[2])};
      for (int step = 0; step < 3; ++step) {
        ++at[kOrders[o][step]];
        tet[step + 1] = index(at[0], at[1], at[2]);
      }
      if (o >= 3) std::swap(tet[2], tet[3]);  // odd permutations turn round
      mesh.tets.push_back(tet);
    }
  }
  mesh.boundary = boundary_of(mesh.tets);
  return mesh;
}

/// A sphere from the icosahedron, every triangle split into four `levels` times; outward.
inline SurfaceMesh icosphere(int levels, double radius = 1, Point3 center = {}) {
  const double t = (1 + std::sqrt(5.0)) / 2;
  SurfaceMesh mesh;
  for (Point3 p : {Point3{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0}, {0, -1, t}, {0, 1, t}, {0, -1, -t},
                   {0, 1, -t}, {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}}) {
    mesh.points.push_back((1 / norm(p)) * p);
  }
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},  {4, 9, 5},  {2, 4, 11},  {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                       static_cast<std::uint32_t>(mesh.points.size()));
      if (is_new) {
        const Point3 m = midpoint(mesh.points[a], mesh.points[b]);
        mesh.points.push_back((1 / norm(m)) * m);
      }
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& f : mesh.triangles) {
      const std::uint32_t a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Point3& p : mesh.points) p = center + radius * p;
  return mesh;
}

/// Appends `other` to `mesh`, points renumbered, nothing merged.
inline void append(SurfaceMesh& mesh, const SurfaceMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (Triangle t : other.triangles) {
    for (std::uint32_t& v : t) v += base;
    mesh.triangles.push_back(t);
  }
}

/// The same surface seen from the other side.
inline SurfaceMesh inverted(SurfaceMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace delvox::test
