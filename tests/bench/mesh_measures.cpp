#include "mesh_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

namespace delvox::bench {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

std::array<std::uint32_t, 3> sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::vector<Triangle> single_faces(const std::vector<Tet>& tets) {
  struct Face {
    std::array<std::uint32_t, 3> key;
    Triangle corners;
  };
  std::vector<Face> faces;
  faces.reserve(4 * tets.size());
  for (const Tet& tet : tets) {
    for (const auto& f : kTetFaces) {
      const Triangle corners{tet[f[0]], tet[f[1]], tet[f[2]]};
      faces.push_back({sorted(corners), corners});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.key < b.key; });
  std::vector<Triangle> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end == i + 1) single.push_back(faces[i].corners);
    i = end;
  }
  return single;
}

void measure_tets(const TetMesh& mesh, MeshMeasures& m) {
  DisjointSets sets(mesh.points.size());
  std::vector<bool> used(mesh.points.size());
  for (const Tet& tet : mesh.tets) {
    std::array<Point3, 4> p;
    for (int i = 0; i < 4; ++i) {
      p[i] = mesh.points[tet[i]];
      used[tet[i]] = true;
      sets.join(tet[0], tet[i]);
    }
    const Vector3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
    const double six_volume = dot(cross(a, b), c);
    if (!(six_volume > 0)) ++m.flat_tets;
    m.volume_mm3 += six_volume / 6;

    const Vector3 offset =
        squared_norm(a) * cross(b, c) + squared_norm(b) * cross(c, a) + squared_norm(c) * cross(a, b);
    const double radius = norm(offset) / std::abs(2 * six_volume);
    double shortest = HUGE_VAL;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) shortest = std::min(shortest, distance(p[i], p[j]));
    m.max_circumradius = std::max(m.max_circumradius, radius);
    m.max_radius_edge = std::max(m.max_radius_edge, radius / shortest);

    std::array<Vector3, 4> normal;
    for (int i = 0; i < 4; ++i) {
      const auto& f = kTetFaces[i];
      normal[i] = cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]);
    }
    double smallest = std::numbers::pi;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        smallest = std::min(smallest, std::atan2(norm(cross(normal[i], normal[j])), -dot(normal[i], normal[j])));
      }
    m.min_dihedral_degrees = std::min(m.min_dihedral_degrees, kDegrees * smallest);
    m.slivers += kDegrees * smallest < kMinDihedralDegrees;
  }
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    m.vertices += used[v];
    m.parts += used[v] && sets.root(v) == v;
  }
}

double smallest_angle(const std::array<Point3, 3>& p) {
  double smallest = std::numbers::pi;
  for (int i = 0; i < 3; ++i) {
    const Vector3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
    smallest = std::min(smallest, std::atan2(norm(cross(u, v)), dot(u, v)));
  }
  return kDegrees * smallest;
}

// Corners (triangle, vertex) that share a manifold edge belong to one fan; a vertex of a 2-manifold has one fan.
void measure_manifoldness(const std::vector<Triangle>& triangles, std::size_t points, MeshMeasures& m) {
  struct Side {
    std::array<std::uint32_t, 2> key;  // vertices, ascending
    std::array<std::uint32_t, 2> corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t j = (i + 1) % 3, u = triangles[t][i], v = triangles[t][j];
      sides.push_back(u < v ? Side{{u, v}, {3 * t + i, 3 * t + j}} : Side{{v, u}, {3 * t + j, 3 * t + i}});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key < b.key; });
  DisjointSets fans(3 * triangles.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].key == sides[i].key) ++end;
    if (end == i + 2) {
      for (int k = 0; k < 2; ++k) fans.join(sides[i].corner[k], sides[i + 1].corner[k]);
    } else {
      ++m.bad_edges;
    }
    i = end;
  }
  std::vector<std::uint32_t> fan_count(points);
  for (std::uint32_t corner = 0; corner < 3 * triangles.size(); ++corner) {
    if (fans.root(corner) == corner) ++fan_count[triangles[corner / 3][corner % 3]];
  }
  for (const std::uint32_t count : fan_count) m.bad_vertices += count > 1;
}

void measure_boundary(const TetMesh& mesh, const BenchImage& image, MeshMeasures& m) {
  const std::vector<Triangle> triangles = single_faces(mesh.tets);
  m.boundary_triangles = triangles.size();
  std::vector<bool> on_boundary(mesh.points.size());
  for (const Triangle& t : triangles) {
    m.min_angle_degrees =
        std::min(m.min_angle_degrees, smallest_angle({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]}));
    for (const std::uint32_t v : t) on_boundary[v] = true;
  }
  std::size_t count = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (!on_boundary[v]) continue;
    Vector3 gradient;
    const double value = image.value(image.to_grid(mesh.points[v]), &gradient);
    const double slope = norm(gradient);
    const double off = value == 0 ? 0 : std::abs(value) / std::max(slope, 1e-30);
    m.max_off_voxels = std::max(m.max_off_voxels, off);
    m.mean_off_voxels += off;
    ++count;
  }
  m.mean_off_voxels /= static_cast<double>(std::max<std::size_t>(count, 1));
  measure_manifoldness(triangles, mesh.points.size(), m);
}

}  // namespace

MeshMeasures measure(const TetMesh& mesh, const BenchImage& image) {
  MeshMeasures m;
  m.tets = mesh.tets.size();
  measure_tets(mesh, m);
  measure_boundary(mesh, image, m);
  return m;
}

}  // namespace delvox::bench
