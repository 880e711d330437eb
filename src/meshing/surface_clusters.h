#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// A point of a surface, and how far from it the surface may go on without another such point, mm.
struct SurfaceSample {
  Point3 point;
  double reach = 0;
};

/// A sample that stands for those around it too: all of them, with their reach, are within its own reach.
struct SurfaceCluster {
  Point3 point;
  double reach = 0;
  std::uint32_t first_part = 0, parts = 0;  ///< clusters that it consists of; none: a sample

  bool can_open() const { return parts > 0; }
};

/// Samples of a surface in clusters, and those in larger ones, by the cubes of an octree. The last one holds them all.
/// pre: all samples are within `half_width` of `center` along each axis.
std::vector<SurfaceCluster> cluster(std::span<const SurfaceSample> samples, const Point3& center, double half_width);

}  // namespace delvox
