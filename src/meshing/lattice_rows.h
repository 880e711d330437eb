#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// Parallel lines along x through a body-centred lattice of ny by nz cubes: first those through corners, at
/// y = origin.y + j * step, z likewise with k, then as many half a step further, through centres. j is fastest.
struct LatticeRows {
  Point3 origin;
  double step = 1;
  std::int32_t ny = 0, nz = 0;
};

/// Where a row enters another region.
struct RowCrossing {
  double x = 0;
  Label label = 0;  ///< beyond x
};

/// The crossings of rows with the restricted triangles, row after row, each in the order of x.
struct RowCrossings {
  std::vector<std::uint32_t> first;  ///< of each row, and one for the end
  std::vector<RowCrossing> crossings;
};

/// All crossings. The rows see a closed surface: a row through an edge crosses exactly one of two triangles that it
/// passes between, none or both of two that fold back. pre: every restricted triangle has its surface ball.
RowCrossings find_row_crossings(const RestrictedDelaunay& delaunay, const LatticeRows& rows);

}  // namespace delvox
