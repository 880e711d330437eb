#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox::test {

/// A point of a quadrature on a tet, straight or curved.
struct TetSample {
  Point3 where;
  double weight = 0;                  ///< mm3; negative where the tet is inside out
  std::array<double, 10> shape{};     ///< of corners and mid-side nodes; of a tet of first order the corners' alone
};

/// Gauss's four points of (0, 1) for each of three directions, brought from the cube to the tet (Duffy): exact for
/// polynomials up to the degree 5 on straight tets.
struct TetRule {
  std::vector<std::array<double, 4>> barycentric;
  std::vector<double> weights;  ///< they add up to 1/6

  TetRule() {
    constexpr double kAt[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
    constexpr double kWeight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) {
          const double r = kAt[i], s = kAt[j] * (1 - r), t = kAt[k] * (1 - r) * (1 - kAt[j]);
          barycentric.push_back({1 - r - s - t, r, s, t});
          weights.push_back(kWeight[i] * kWeight[j] * kWeight[k] * (1 - r) * (1 - r) * (1 - kAt[j]));
        }
      }
    }
  }
};

/// Calls visit(TetSample) at the points of the quadrature on a tet of the mesh.
template <class Visit>
void for_each_sample(const TetMesh& mesh, std::size_t tet, const Visit& visit) {
  static const TetRule rule;
  const bool second_order = !mesh.mid_nodes.empty();
  const std::size_t nodes = second_order ? 10 : 4;
  std::array<Point3, 10> p;
  for (std::size_t i = 0; i < nodes; ++i) p[i] = mesh.points[i < 4 ? mesh.tets[tet][i] : mesh.mid_nodes[tet][i - 4]];
  for (std::size_t q = 0; q < rule.weights.size(); ++q) {
    const std::array<double, 4>& l = rule.barycentric[q];
    TetSample sample;
    std::array<Vector3, 3> along{};  // derivatives of the place by l[1], l[2], l[3], with l[0] = 1 - the others
    const auto add = [&](std::size_t node, double shape, const std::array<double, 4>& by) {
      sample.shape[node] = shape;
      sample.where = sample.where + shape * p[node];
      for (std::size_t d = 0; d < 3; ++d) along[d] = along[d] + (by[d + 1] - by[0]) * p[node];
    };
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<double, 4> by{};
      by[i] = second_order ? 4 * l[i] - 1 : 1;
      add(i, second_order ? l[i] * (2 * l[i] - 1) : l[i], by);
    }
    for (std::size_t e = 0; e + 4 < nodes; ++e) {
      const auto a = static_cast<std::size_t>(kTetEdges[e][0]), b = static_cast<std::size_t>(kTetEdges[e][1]);
      std::array<double, 4> by{};
      by[a] = 4 * l[b];
      by[b] = 4 * l[a];
      add(4 + e, 4 * l[a] * l[b], by);
    }
    sample.weight = rule.weights[q] * dot(along[0], cross(along[1], along[2]));
    visit(sample);
  }
}

}  // namespace delvox::test
