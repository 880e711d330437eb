#include "check/crossing_triangles.h"

#include <algorithm>
#include <cmath>

#include "check/exact_orientation.h"
#include "check/triangle_tree.h"

namespace delvox::check {
namespace {

class PairTest {
 public:
  PairTest(const std::vector<Point3>& points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles) {}

  bool cross(std::uint32_t i, std::uint32_t j) const {
    const Triangle &s = triangles_[i], &t = triangles_[j];
    const auto shared_by = [](const Triangle& other, std::uint32_t v) {
      return std::find(other.begin(), other.end(), v) != other.end();
    };
    const auto shared = std::count_if(s.begin(), s.end(), [&](std::uint32_t v) { return shared_by(t, v); });
    if (shared == 3) return false;  // "no duplicate triangles" names these
    if (shared == 2) return folded(s, t);
    // Edges that start in a shared vertex meet the other triangle there, rightly.
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = s[e], b = s[(e + 1) % 3], c = t[e], d = t[(e + 1) % 3];
      if (!shared_by(t, a) && !shared_by(t, b) && pierces(a, b, t)) return true;
      if (!shared_by(s, c) && !shared_by(s, d) && pierces(c, d, s)) return true;
    }
    return false;
  }

 private:
  int side(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    return orientation(points_[a], points_[b], points_[c], points_[d]);
  }

  bool pierces(std::uint32_t p, std::uint32_t q, const Triangle& t) const {
    const int at_p = side(t[0], t[1], t[2], p), at_q = side(t[0], t[1], t[2], q);
    if (at_p * at_q > 0 || (at_p == 0 && at_q == 0)) return false;
    const int around[3] = {side(p, q, t[0], t[1]), side(p, q, t[1], t[2]), side(p, q, t[2], t[0])};
    const auto [low, high] = std::minmax_element(around, around + 3);
    return *low * *high >= 0;
  }

  // Two triangles with a common edge overlap only if they lie in one plane, on the same side of the edge.
  bool folded(const Triangle& s, const Triangle& t) const {
    std::uint32_t edge[2]{}, apex_s = 0, apex_t = 0;
    int found = 0;
    for (std::uint32_t v : s) {
      if (std::find(t.begin(), t.end(), v) == t.end()) apex_s = v;
      else if (found < 2) edge[found++] = v;
    }
    for (std::uint32_t v : t) {
      if (std::find(s.begin(), s.end(), v) == s.end()) apex_t = v;
    }
    if (side(edge[0], edge[1], apex_s, apex_t) != 0) return false;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const int at_s = planar_orientation(points_[edge[0]], points_[edge[1]], points_[apex_s], u, v);
      const int at_t = planar_orientation(points_[edge[0]], points_[edge[1]], points_[apex_t], u, v);
      if (at_s * at_t != 0) return at_s == at_t;
    }
    return false;
  }

  const std::vector<Point3>& points_;
  std::span<const Triangle> triangles_;
};

}  // namespace

Tally crossing_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles) {
  const TriangleTree tree(points, triangles);
  const PairTest pair(points, triangles);
  Tally crossings;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    Box3 box;
    for (std::uint32_t v : triangles[i]) box.extend(points[v]);
    tree.for_each_in(box, [&](std::uint32_t j) {
      if (i < j && pair.cross(i, j)) crossings.add(points[triangles[i][0]]);
    });
  }
  return crossings;
}

}  // namespace delvox::check
