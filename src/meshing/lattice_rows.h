#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// Parallel lines along x through a lattice of ny by nz places: y = origin.y + (j + shift) * step, z likewise with k.
struct LatticeRows {
  Point3 origin;
  double step = 1, shift = 0;
  std::int32_t ny = 0, nz = 0;
};

/// Where a row enters another region.
struct RowCrossing {
  double x = 0;
  Label label = 0;  ///< beyond x
};

/// The crossings of rows with the restricted triangles, row after row (j fastest), each in the order of x.
struct RowCrossings {
  std::vector<std::uint32_t> first;  ///< of each row, and one for the end
  std::vector<RowCrossing> crossings;
};

/// All crossings with these, the restricted triangles. The rows see a closed surface: a row through an edge crosses exactly one of two triangles that it
/// passes between, none or both of two that fold back.
RowCrossings find_row_crossings(const RestrictedDelaunay& delaunay, const std::vector<FacetId>& triangles,
                                const LatticeRows& rows);

}  // namespace delvox
