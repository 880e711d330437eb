#include "oracle/polygon_tree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Cartesian_converter.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace delvox {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

Kernel::Point_3 cgal(const Point3& p) { return {p.x, p.y, p.z}; }
Point3 plain(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
int sign_of_volume(const Kernel::Point_3& a, const Kernel::Point_3& b, const Kernel::Point_3& c,
                   const Kernel::Point_3& d) {
  return CGAL::orientation(a, b, c, d);
}

enum class Answer { kNo, kYes, kUndecided };

/// Segment pq, its end q moved infinitesimally towards r, against triangles. pre: p lies on none of them.
class MovedSegment {
 public:
  MovedSegment(const Kernel::Point_3& p, const Kernel::Point_3& q, const Kernel::Point_3& r) : p_(p), q_(q), r_(r) {}

  Answer crosses(const Kernel::Triangle_3& t) const {
    const int at_p = sign_of_volume(t[0], t[1], t[2], p_);
    if (at_p == 0) return Answer::kNo;  // it leaves the plane at once, beside the triangle
    int at_q = sign_of_volume(t[0], t[1], t[2], q_);
    if (at_q == 0) at_q = sign_of_volume(t[0], t[1], t[2], r_);
    if (at_q == at_p) return Answer::kNo;
    std::array<int, 3> around;
    for (int i = 0; i < 3; ++i) around[i] = sign_of_volume(p_, q_, t[i], t[(i + 1) % 3]);
    const auto differ = [&] { return *std::min_element(around.begin(), around.end()) < 0 &&
                                     *std::max_element(around.begin(), around.end()) > 0; };
    if (differ()) return Answer::kNo;
    for (int i = 0; i < 3; ++i) {
      if (around[i] == 0) around[i] = sign_of_volume(p_, r_, t[i], t[(i + 1) % 3]);
    }
    if (differ()) return Answer::kNo;
    const bool decided = at_q != 0 && std::find(around.begin(), around.end(), 0) == around.end();
    return decided ? Answer::kYes : Answer::kUndecided;
  }

 private:
  const Kernel::Point_3 &p_, &q_, &r_;
};

double six_volumes(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return dot(cross(b - a, c - a), d - a);
}

}  // namespace

struct PolygonTree::Impl {
  Triangles triangles;
  Tree tree;
  std::vector<Kernel::Point_3> aims;  // what a segment's end may be moved towards
  Kernel::Point_3 beyond;             // outside the surface's box
  double rounding = 0;                // mm: two ways to compute a point agree to this unless both are poor

  /// Triangles that the closed segment ab meets.
  std::vector<std::uint32_t>& met_by(const Kernel::Point_3& a, const Kernel::Point_3& b) const {
    thread_local std::vector<Tree::Primitive_id> primitives;
    thread_local std::vector<std::uint32_t> met;
    primitives.clear();
    met.clear();
    if (a != b) tree.all_intersected_primitives(Kernel::Segment_3(a, b), std::back_inserter(primitives));
    for (const auto& primitive : primitives) met.push_back(static_cast<std::uint32_t>(primitive - triangles.begin()));
    return met;
  }

  bool lies_on(const Kernel::Point_3& p, const std::vector<std::uint32_t>& met) const {
    return std::any_of(met.begin(), met.end(), [&](std::uint32_t t) { return triangles[t].has_on(p); });
  }

  /// Keeps those of `met` that ab crosses.
  void keep_crossed(const Kernel::Point_3& a, const Kernel::Point_3& b, std::vector<std::uint32_t>& met) const {
    thread_local std::vector<std::uint32_t> crossed;
    for (const Kernel::Point_3& aim : aims) {
      const MovedSegment segment(a, b, aim);
      crossed.clear();
      bool decided = true;
      for (std::uint32_t t : met) {
        const Answer answer = segment.crosses(triangles[t]);
        decided &= answer != Answer::kUndecided;
        if (answer == Answer::kYes) crossed.push_back(t);
      }
      if (decided) break;
    }
    met.swap(crossed);
  }

  Crossing crossing(const Point3& a, const Point3& b, std::uint32_t t) const {
    const Point3 p = plain(triangles[t][0]), q = plain(triangles[t][1]), r = plain(triangles[t][2]);
    const double at_a = six_volumes(p, q, r, a), at_b = six_volumes(p, q, r, b);
    const double along = at_a / (at_a - at_b);
    // Weights of the corners: a point on the triangle, whatever the rounding.
    const double u = std::abs(six_volumes(a, b, q, r)), v = std::abs(six_volumes(a, b, r, p));
    const double w = std::abs(six_volumes(a, b, p, q)), sum = u + v + w;
    const Point3 point = (u / sum) * p + (v / sum) * q + (w / sum) * r;
    const bool agree = along >= 0 && along <= 1 && distance(point, a + along * (b - a)) <= rounding;
    return agree ? Crossing{along, t, point} : exact_crossing(a, b, t);
  }

  /// For segments that graze the triangle's plane.
  Crossing exact_crossing(const Point3& a, const Point3& b, std::uint32_t t) const {
    const CGAL::Cartesian_converter<Kernel, Exact> exact;
    const Exact::Point_3 p = exact(cgal(a)), q = exact(cgal(b));
    const Exact::Triangle_3 triangle = exact(triangles[t]);
    const auto volume_at_p = CGAL::volume(triangle[0], triangle[1], triangle[2], p);
    const auto difference = volume_at_p - CGAL::volume(triangle[0], triangle[1], triangle[2], q);
    if (difference == 0) return {0, t, a};  // in the plane: both ends are as good
    const Exact::FT along = volume_at_p / difference;
    const Exact::Point_3 point = p + along * (q - p);
    return {CGAL::to_double(along), t, {CGAL::to_double(point.x()), CGAL::to_double(point.y()), CGAL::to_double(point.z())}};
  }
};

PolygonTree::PolygonTree(const PolygonSurface& surface) : impl_(std::make_unique<Impl>()) {
  Box3 box;
  for (const Point3& p : surface.points) box.extend(p);
  impl_->rounding = 1e-11 * (box.diagonal() + norm(box.center()));
  for (const Point3 direction : {Point3{0.3141, 0.5926, 0.5358}, {-0.9793, 0.2384, 0.6264}, {0.3383, -0.2795, 0.0288},
                                 {-0.4197, -0.1693, 0.9937}, {0.5105, 0.8209, -0.7494}}) {
    impl_->aims.push_back(cgal(box.center() + box.diagonal() * direction));
  }
  impl_->beyond = cgal(box.center() + box.diagonal() * Vector3{0.8427, 0.5772, 0.6180});
  impl_->triangles.reserve(surface.triangles.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    impl_->triangles.emplace_back(cgal(surface.corner(t, 0)), cgal(surface.corner(t, 1)), cgal(surface.corner(t, 2)));
  }
  impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
}

PolygonTree::~PolygonTree() = default;

std::vector<PolygonTree::Crossing> PolygonTree::crossings(const Point3& a, const Point3& b) const {
  const Kernel::Point_3 p = cgal(a), q = cgal(b);
  std::vector<std::uint32_t>& crossed = impl_->met_by(p, q);
  impl_->keep_crossed(p, q, crossed);
  std::vector<Crossing> result;
  for (std::uint32_t t : crossed) result.push_back(impl_->crossing(a, b, t));
  std::sort(result.begin(), result.end(), [](const Crossing& c, const Crossing& d) {
    return c.t != d.t ? c.t < d.t : c.triangle < d.triangle;
  });
  return result;
}

PolygonTree::Parity PolygonTree::parity(const Point3& a, const Point3& b) const {
  const Kernel::Point_3 p = cgal(a), q = cgal(b);
  std::vector<std::uint32_t>& crossed = impl_->met_by(p, q);
  if (crossed.empty()) return Parity::kEven;
  if (impl_->lies_on(p, crossed)) return Parity::kOnSurface;
  impl_->keep_crossed(p, q, crossed);
  return crossed.size() % 2 == 1 ? Parity::kOdd : Parity::kEven;
}

std::vector<bool> PolygonTree::cavities(const PolygonSurface& surface) const {
  std::vector<bool> cavity(surface.components, false), met(surface.components, false);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t component = surface.component_of[t];
    if (met[component]) continue;
    met[component] = true;
    const Kernel::Point_3 vertex = impl_->triangles[t][0], beyond = impl_->beyond;
    std::vector<std::uint32_t>& others = impl_->met_by(vertex, beyond);
    std::erase_if(others, [&](std::uint32_t other) { return surface.component_of[other] == component; });
    impl_->keep_crossed(vertex, beyond, others);
    cavity[component] = others.size() % 2 == 1;
  }
  return cavity;
}

}  // namespace delvox
