#include "delaunay/circumsphere.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

namespace delvox {
namespace {

using ExactKernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;

Circumsphere exact_circumsphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const auto exact = [](const Point3& p) { return ExactKernel::Point_3(p.x, p.y, p.z); };
  const ExactKernel::Point_3 center = CGAL::circumcenter(exact(a), exact(b), exact(c), exact(d));
  return {{CGAL::to_double(center.x()), CGAL::to_double(center.y()), CGAL::to_double(center.z())},
          CGAL::to_double(CGAL::squared_distance(center, exact(a)))};
}

}  // namespace

Circumsphere circumsphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Vector3 u = b - a, v = c - a, w = d - a;
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  const Vector3 vw = cross(v, w);
  const double six_volume = dot(u, vw);
  if (six_volume * six_volume < kSafeRatio * uu * vv * ww) return exact_circumsphere(a, b, c, d);
  const Vector3 offset = (0.5 / six_volume) * (uu * vw + vv * cross(w, u) + ww * cross(u, v));
  return {a + offset, squared_norm(offset)};
}

}  // namespace delvox
