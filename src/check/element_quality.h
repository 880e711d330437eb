#pragma once

#include <span>
#include <vector>

#include "delvox/check/check_mesh.h"

namespace delvox::check {

/// How far each point may have moved when its coordinates were rounded by the file format, mm.
struct Precision {
  double displacement_mm = 0;
};

/// The worst value of a quantity and the elements that break its bound beyond tolerance.
struct Extreme {
  double value = 0;
  bool any = false;
  Point3 where;
  std::size_t violations = 0;
};

/// Circumcentre of a triangle, in its plane.
Point3 circumcenter(const Point3& a, const Point3& b, const Point3& c);

struct TriangleQuality {
  Extreme angle;         ///< smallest, degrees
  Extreme circumradius;  ///< largest
  std::size_t degenerate = 0;  ///< no area at the format's precision
  Point3 degenerate_where;
  Distribution angles, edges;
};
TriangleQuality measure_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                  const Promises& bounds, Precision precision);

struct TetQuality {
  Extreme radius_edge;   ///< largest
  Extreme circumradius;  ///< largest
  Extreme dihedral;      ///< smallest, degrees
  double volume_mm3 = 0;
  Distribution dihedrals, ratios, edges;
};
TetQuality measure_tets(const std::vector<Point3>& points, std::span<const Tet> tets, const Promises& bounds,
                        Precision precision);

}  // namespace delvox::check
