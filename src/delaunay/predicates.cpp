#include "delaunay/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace delvox {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_3 cgal(const Point3& p) {
  return {p.x, p.y, p.z};
}

/// Every point is lifted onto the paraboloid and then raised by an infinitely small amount, the lexicographically
/// largest by the most: the first raised point whose cofactor in the in-sphere determinant is not zero decides. The
/// cofactor of a corner of the tet is the volume of the tet with p in its place, and p itself, when raised, is outside.
bool in_sphere_perturbed(const std::array<Point3, 4>& tet, const Point3& p) {
  std::array<const Point3*, 5> by_weight{&tet[0], &tet[1], &tet[2], &tet[3], &p};
  std::sort(by_weight.begin(), by_weight.end(),
            [](const Point3* a, const Point3* b) { return std::tie(a->x, a->y, a->z) > std::tie(b->x, b->y, b->z); });
  for (const Point3* raised : by_weight) {
    if (raised == &p) return false;
    std::array<Point3, 4> replaced = tet;
    replaced[static_cast<std::size_t>(raised - tet.data())] = p;
    const int cofactor = orientation(replaced[0], replaced[1], replaced[2], replaced[3]);
    if (cofactor != 0) return cofactor > 0;
  }
  return false;
}

}  // namespace

int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return CGAL::orientation(cgal(a), cgal(b), cgal(c), cgal(d));
}

bool in_sphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& p) {
  const CGAL::Oriented_side side = CGAL::side_of_oriented_sphere(cgal(a), cgal(b), cgal(c), cgal(d), cgal(p));
  if (side == CGAL::ON_ORIENTED_BOUNDARY) return in_sphere_perturbed({a, b, c, d}, p);
  return side == CGAL::ON_POSITIVE_SIDE;
}

}  // namespace delvox
