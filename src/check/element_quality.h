#pragma once

#include <span>
#include <vector>

#include "check/surface_topology.h"
#include "delvox/check/check_mesh.h"

namespace delvox::check {

/// How far each point may have moved when its coordinates were rounded by the file format, mm.
struct Precision {
  double displacement_mm = 0;
};

/// The worst value of a quantity, the first place that has it, and the elements that break its bound beyond tolerance.
struct Extreme {
  double value = 0;
  bool any = false;
  Point3 where;
  std::size_t violations = 0;
};

/// Notes a value if it is the largest so far; where() is asked only then.
template <class Where>
void keep_largest(Extreme& extreme, double value, const Where& where) {
  if (extreme.any && !(value > extreme.value)) return;
  extreme = {value, true, where(), extreme.violations};
}

/// Adds what was found in a later part, of a quantity whose largest value is the worst.
inline void append_largest(Extreme& extreme, const Extreme& later) {
  if (later.any) keep_largest(extreme, later.value, [&] { return later.where; });
  extreme.violations += later.violations;
}

/// Circumcentre of a triangle, in its plane.
Point3 circumcenter(const Point3& a, const Point3& b, const Point3& c);

struct TriangleQuality {
  Extreme angle;         ///< smallest, degrees
  Extreme circumradius;  ///< largest
  Tally degenerate;      ///< no area at the format's precision
  Distribution angles, edges;
};
TriangleQuality measure_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                  const Promises& bounds, Precision precision);

struct TetQuality {
  Tally not_positive;    ///< by exact predicates on the coordinates as they are
  Extreme radius_edge;   ///< largest
  Extreme circumradius;  ///< largest
  Extreme dihedral;      ///< smallest, degrees
  double volume_mm3 = 0;
  Distribution dihedrals, ratios, edges;
};
TetQuality measure_tets(const std::vector<Point3>& points, std::span<const Tet> tets, const Promises& bounds,
                        Precision precision);

}  // namespace delvox::check
