#pragma once

#include <cstdint>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// The surface with one point for each place; unused points, and triangles that had two corners in one place, are gone.
/// Points are renumbered in the order of first use; `kept`, if given, gets the former numbers of the triangles.
/// pre: coordinates finite, indices valid.
SurfaceMesh with_equal_points_merged(const SurfaceMesh& mesh, std::vector<std::uint32_t>* kept = nullptr);

}  // namespace delvox
