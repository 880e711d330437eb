#include "oracle/polygon_crossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace delvox {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

Kernel::Point_3 cgal(const Point3& p) { return {p.x, p.y, p.z}; }

class PairTest {
 public:
  PairTest(const std::vector<Point3>& points, const std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles) {}

  bool cross(std::uint32_t s, std::uint32_t t) const {
    Triangle a = triangles_[s], b = triangles_[t];
    const int shared = bring_shared_to_front(a, b);
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    if (shared == 1) {
      // Whatever they share beyond that vertex reaches the opposite edge of one of them.
      return CGAL::do_intersect(triangle(a), segment(b[1], b[2])) ||
             CGAL::do_intersect(triangle(b), segment(a[1], a[2]));
    }
    if (shared == 2) {
      const auto p = cgal(points_[a[0]]), q = cgal(points_[a[1]]), r = cgal(points_[a[2]]), u = cgal(points_[b[2]]);
      return CGAL::coplanar(p, q, r, u) && CGAL::coplanar_orientation(p, q, r, u) == CGAL::POSITIVE;
    }
    return true;
  }

 private:
  static int bring_shared_to_front(Triangle& a, Triangle& b) {
    int shared = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = shared; j < 3; ++j) {
        if (a[i] != b[j]) continue;
        std::swap(a[i], a[shared]);
        std::swap(b[j], b[shared]);
        ++shared;
        break;
      }
    }
    return shared;
  }

  Kernel::Triangle_3 triangle(const Triangle& t) const {
    return {cgal(points_[t[0]]), cgal(points_[t[1]]), cgal(points_[t[2]])};
  }
  Kernel::Segment_3 segment(std::uint32_t a, std::uint32_t b) const { return {cgal(points_[a]), cgal(points_[b])}; }

  const std::vector<Point3>& points_;
  const std::vector<Triangle>& triangles_;
};

}  // namespace

CrossingTriangles find_crossing_triangles(const std::vector<Point3>& points, const std::vector<Triangle>& triangles) {
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    CGAL::Bbox_3 box;
    for (std::uint32_t v : triangles[t]) box += cgal(points[v]).bbox();
    boxes.emplace_back(box, t);
  }
  const PairTest test(points, triangles);
  CrossingTriangles found;
  const auto visit = [&](const Box& a, const Box& b) {
    const std::array<std::uint32_t, 2> pair{std::min(a.info(), b.info()), std::max(a.info(), b.info())};
    if (!test.cross(pair[0], pair[1])) return;
    if (found.pairs++ > 0 && pair >= found.first) return;
    found.first = pair;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = std::max(a.min_coord(axis), b.min_coord(axis));
      found.where[axis] = 0.5 * (low + std::min(a.max_coord(axis), b.max_coord(axis)));
    }
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit);
  return found;
}

bool has_no_area(const Point3& a, const Point3& b, const Point3& c) {
  return CGAL::collinear(cgal(a), cgal(b), cgal(c));
}

}  // namespace delvox
