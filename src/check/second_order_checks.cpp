#include "check/second_order_checks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <tuple>

#include "core/parallel.h"

namespace delvox::check {
namespace {

constexpr std::size_t kChunk = 8192;

/// Where the Jacobian is looked at: reference coordinates of the ten nodes, the four Gauss points of second degree, and
/// the centroid.
std::vector<Point3> sample_points() {
  constexpr double kNear = 0.58541019662496852, kFar = 0.1381966011250105;
  return {{0, 0, 0},          {1, 0, 0},           {0, 1, 0},           {0, 0, 1},           {0.5, 0, 0},
          {0.5, 0.5, 0},      {0, 0.5, 0},         {0, 0, 0.5},         {0.5, 0, 0.5},       {0, 0.5, 0.5},
          {kFar, kFar, kFar}, {kNear, kFar, kFar}, {kFar, kNear, kFar}, {kFar, kFar, kNear}, {0.25, 0.25, 0.25}};
}

/// Derivatives of the ten shape functions with respect to one of r, s, t; corner 0 has coordinate u = 1 - r - s - t.
std::array<double, 10> derivatives(const Point3& at, int axis) {
  const double u = 1 - at.x - at.y - at.z;
  const double l[4] = {u, at.x, at.y, at.z};
  double dl[4] = {-1, 0, 0, 0};
  dl[axis + 1] = 1;
  std::array<double, 10> result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = (4 * l[i] - 1) * dl[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const int a = kTetEdges[e][0], b = kTetEdges[e][1];
    result[4 + e] = 4 * (l[a] * dl[b] + l[b] * dl[a]);
  }
  return result;
}

struct Sample {
  std::array<double, 10> d[3];
};

std::vector<Sample> samples() {
  std::vector<Sample> result;
  for (const Point3& at : sample_points()) {
    result.push_back({{derivatives(at, 0), derivatives(at, 1), derivatives(at, 2)}});
  }
  return result;
}

Extreme worst_jacobian(const TetMesh& mesh, const std::vector<double>& ratios) {
  Extreme worst;
  for (std::size_t t = 0; t < ratios.size(); ++t) {
    if (!worst.any || ratios[t] < worst.value) {
      worst = {ratios[t], true, mesh.points[mesh.tets[t][0]], worst.violations};
    }
    if (!(ratios[t] > 0)) ++worst.violations;
  }
  return worst;
}

struct EdgeNode {
  std::uint32_t a, b, middle;
  bool on_boundary;
};

std::vector<EdgeNode> edge_nodes(const TetMesh& mesh) {
  std::vector<EdgeNode> edges;
  edges.reserve(6 * mesh.tets.size());
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t middle, bool on_boundary) {
    edges.push_back({std::min(a, b), std::max(a, b), middle, on_boundary});
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t e = 0; e < 6; ++e) {
      add(mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][0])],
          mesh.tets[t][static_cast<std::size_t>(kTetEdges[e][1])], mesh.mid_nodes[t][e], false);
    }
  }
  for (TetFace face : boundary_faces(mesh.tets)) {
    const Triangle corners = face_corners(mesh.tets, face);
    const auto middles = face_mid_nodes(mesh.mid_nodes[face.tet], face.face);
    for (std::size_t i = 0; i < 3; ++i) add(corners[i], corners[(i + 1) % 3], middles[i], true);
  }
  std::sort(edges.begin(), edges.end(), [](const EdgeNode& x, const EdgeNode& y) {
    return std::tie(x.a, x.b, x.middle, x.on_boundary) < std::tie(y.a, y.b, y.middle, y.on_boundary);
  });
  return edges;
}

}  // namespace

std::vector<double> jacobian_ratios(const TetMesh& mesh) {
  const std::vector<Sample> at = samples();
  std::vector<double> ratios(mesh.tets.size());
  for_each_chunk(mesh.tets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      std::array<Point3, 10> nodes;
      for (std::size_t i = 0; i < 4; ++i) nodes[i] = mesh.points[mesh.tets[t][i]];
      for (std::size_t e = 0; e < 6; ++e) nodes[4 + e] = mesh.points[mesh.mid_nodes[t][e]];
      double least = std::numeric_limits<double>::infinity(), greatest = -least;
      for (const Sample& sample : at) {
        Vector3 column[3];
        for (int axis = 0; axis < 3; ++axis) {
          for (std::size_t i = 0; i < 10; ++i) column[axis] = column[axis] + sample.d[axis][i] * nodes[i];
        }
        const double determinant = dot(cross(column[0], column[1]), column[2]);
        least = std::min(least, determinant);
        greatest = std::max(greatest, determinant);
      }
      ratios[t] = greatest > 0 ? least / greatest : -1;
    }
  });
  return ratios;
}

SecondOrderQuality measure_second_order(const TetMesh& mesh) {
  SecondOrderQuality result;
  result.jacobian = worst_jacobian(mesh, jacobian_ratios(mesh));
  std::vector<std::uint8_t> taken(mesh.points.size(), 0);
  for (const Tet& tet : mesh.tets) {
    for (std::uint32_t v : tet) taken[v] = 1;
  }
  const std::vector<EdgeNode> edges = edge_nodes(mesh);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EdgeNode& edge = edges[i];
    const bool same_edge = i > 0 && edges[i - 1].a == edge.a && edges[i - 1].b == edge.b;
    if (!same_edge || edges[i - 1].middle != edge.middle) {
      if (same_edge || taken[edge.middle] != 0) result.not_shared.add(mesh.points[edge.middle]);
      taken[edge.middle] = 1;
    }
    if (edge.on_boundary) result.on_boundary.push_back(edge.middle);
  }
  std::sort(result.on_boundary.begin(), result.on_boundary.end());
  result.on_boundary.erase(std::unique(result.on_boundary.begin(), result.on_boundary.end()), result.on_boundary.end());
  return result;
}

}  // namespace delvox::check
