#pragma once

#include <array>

#include "delvox/core/geometry.h"

namespace delvox::mesh_io {

/// Circumradius / shortest edge of a tet; infinite for a flat one.
double radius_edge_ratio(const std::array<Point3, 4>& p);

/// The smallest of the six dihedral angles of a tet; 0 for a flat one.
double min_dihedral_degrees(const std::array<Point3, 4>& p);

/// The smallest angle of a triangle; 0 if two corners coincide.
double min_angle_degrees(const std::array<Point3, 3>& p);

}  // namespace delvox::mesh_io
