#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// An edge where two triangles meet at an angle.
struct SharpEdge {
  Edge ends{};                               ///< the lower number first
  std::array<std::uint32_t, 2> triangles{};  ///< the lower number first
};

/// The edges of two triangles whose normals, both taken from the same side of the surface, are more than `degrees`
/// apart (0: they lie in one plane, 180: one lies upon the other), in the order of their ends. Triangles may face
/// either way. Edges of one triangle, or of three and more, do not count. pre: indices valid.
std::vector<SharpEdge> sharp_edges(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                   double degrees);

}  // namespace delvox
