#pragma once

#include <array>

#include "core/pair_geometry.h"
#include "delvox/core/geometry.h"

namespace delvox::mesh_io {

using TetCorners = std::array<Point3, 4>;

/// Circumradius / shortest edge of each of two tets; infinite for flat ones.
Pair radius_edge_ratios(const TetCorners& first, const TetCorners& second);

/// The smallest of the six dihedral angles of each of two tets; 0 for flat ones.
Pair min_dihedrals_degrees(const TetCorners& first, const TetCorners& second);

/// The smallest angle of a triangle; 0 if two corners coincide.
double min_angle_degrees(const std::array<Point3, 3>& p);

}  // namespace delvox::mesh_io
