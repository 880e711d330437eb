#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delvox/check/check_mesh.h"

namespace delvox::check {

/// Something counted, with one place where it occurs.
struct Tally {
  std::size_t count = 0;
  Point3 where;
  void add(const Point3& p) {
    if (count++ == 0) where = p;
  }
  /// Appends what was counted later.
  void append(const Tally& later) {
    if (count == 0) where = later.where;
    count += later.count;
  }
};

inline Tally sum_of(const std::vector<Tally>& parts) {
  Tally sum;
  for (const Tally& part : parts) sum.append(part);
  return sum;
}

/// How the triangles of a surface hang together. pre: indices valid.
struct SurfaceTopology {
  std::size_t vertices = 0, edges = 0;
  long euler = 0;
  std::vector<std::array<std::uint32_t, 2>> rim;  ///< edges of one triangle only
  Tally crowded_edges;                            ///< edges of more than two triangles
  Tally misoriented_edges;                        ///< edges that two triangles run through in the same direction
  Tally crowded_vertices;                         ///< vertices whose triangles form more than one fan
  Tally duplicate_triangles;
  std::vector<ComponentStatistics> components;  ///< largest area first
  std::vector<std::uint32_t> component_of;      ///< per triangle, an index into components

  bool closed_manifold() const { return rim.empty() && crowded_edges.count == 0 && misoriented_edges.count == 0; }
};

SurfaceTopology surface_topology(const std::vector<Point3>& points, std::span<const Triangle> triangles);

/// Components whose sign of volume does not fit their nesting: one inside an even number of others must be positive,
/// else negative. pre: closed_manifold().
Tally wrongly_oriented_components(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                  const SurfaceTopology& topology);

}  // namespace delvox::check
