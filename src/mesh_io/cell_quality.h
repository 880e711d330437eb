#pragma once

#include <array>

#include "delvox/core/geometry.h"

namespace delvox::mesh_io {

struct TetQuality {
  double radius_edge;           ///< circumradius / shortest edge; infinite for a flat tet
  double min_dihedral_degrees;  ///< the smallest of the six
};

TetQuality tet_quality(const std::array<Point3, 4>& p);

double min_angle_degrees(const std::array<Point3, 3>& p);

}  // namespace delvox::mesh_io
