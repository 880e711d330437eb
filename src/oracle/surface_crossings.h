#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"
#include "oracle/brick_field.h"

namespace delvox {

/// A grid edge whose ends lie on different sides of the isosurface.
struct GridCrossing {
  std::array<int, 3> sample;      ///< lower end
  int axis = 0;                   ///< direction of the edge
  double position = 0;            ///< of the crossing from the lower end, 0 to 1
  std::uint32_t component = 0;    ///< of the surface

  Point3 point() const {
    Point3 p{double(sample[0]), double(sample[1]), double(sample[2])};
    p[axis] += position;
    return p;
  }
};

struct GridCrossings {
  std::vector<GridCrossing> crossings;  ///< in the order of bricks
  std::size_t components = 0;
};

/// All crossed grid edges with the surface component each belongs to: two crossings are joined if a curve of the
/// isosurface on a grid face connects them (face decider of Nielson and Hamann 1991 where four edges are crossed).
/// Sheets that meet only by a tunnel inside a cell count as two.
GridCrossings find_crossings(const BrickField& field);

}  // namespace delvox
