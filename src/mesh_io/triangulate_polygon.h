#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox::mesh_io {

/// Cuts a polygon in space into triangles of the same orientation: a fan if it is convex, by ears if not.
/// nullopt if it has fewer than 3 corners, crosses itself so that no ear is left, or is too large to try.
std::optional<std::vector<Triangle>> triangulate_polygon(std::span<const std::uint32_t> corners,
                                                         std::span<const Point3> points);

}  // namespace delvox::mesh_io
