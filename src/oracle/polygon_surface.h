#pragma once

#include <cstdint>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// A closed surface that bounds something, found to be sound.
struct PolygonSurface {
  std::vector<Point3> points;               ///< all different, all used
  std::vector<Triangle> triangles;          ///< in each component oriented alike, its volume positive
  std::vector<std::uint32_t> component_of;  ///< per triangle
  std::uint32_t components = 0;

  const Point3& corner(std::uint32_t triangle, int i) const { return points[triangles[triangle][i]]; }
};

/// Throws InputError as make_polygon_oracle says.
PolygonSurface sound_surface(const SurfaceMesh& mesh);

}  // namespace delvox
