#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"
#include "oracle/brick_edges.h"
#include "oracle/brick_field.h"

namespace delvox {

/// A grid edge whose ends lie on different sides of the isosurface.
struct CrossedEdge {
  std::array<int, 3> sample{};  ///< lower end
  int axis = 0;                 ///< direction
  float low = 0, high = 0;      ///< samples at its ends

  /// Where the isosurface crosses it, in grid coordinates.
  Point3 point(double level) const {
    Point3 p{double(sample[0]), double(sample[1]), double(sample[2])};
    p[axis] += (level - low) / (static_cast<double>(high) - low);
    return p;
  }
};

/// Calls visit(edge) for the crossed grid edges that belong to a mixed brick, in one fixed order: nothing that can be
/// found again as fast as it is read needs to be stored for each.
template <class Visit>
void for_each_crossed_edge(const BrickField& field, const std::array<int, 3>& brick, const BrickEdges& edges,
                           const Visit& visit) {
  constexpr int kBrick = BrickField::kBrick, kBlock = BrickField::kBlock;
  const float* block = field.block(brick);
  edges.for_each_crossed([&](int layer, int axis, int bit) {
    const int i = bit % kBrick, j = bit / kBrick;
    const float* low = block + (layer * kBlock + j) * kBlock + i;
    visit(CrossedEdge{{brick[0] * kBrick + i, brick[1] * kBrick + j, brick[2] * kBrick + layer},
                      axis,
                      low[0],
                      low[BrickField::kBlockStride[axis]]});
  });
}

/// The components of an isosurface.
struct SurfaceComponents {
  struct Component {
    Box3 box;  ///< of its crossings, in grid coordinates
    std::size_t crossings = 0;
  };
  std::vector<Component> components;
  std::vector<std::uint32_t> in_brick;     ///< how many crossings, in the order of for_each_mixed_brick
  std::vector<std::uint32_t> of_crossing;  ///< in the order of for_each_mixed_brick and for_each_crossed_edge
};

/// The surface component of each crossed grid edge: two crossings are joined if a curve of the isosurface on a grid face
/// connects them (face decider of Nielson and Hamann 1991 where four edges are crossed). Sheets that meet only by a
/// tunnel inside a cell count as two. `go_on` is asked once a brick, by the calling thread; its answer is not heeded, but it may throw.
SurfaceComponents find_components(const BrickField& field, const GoOn& go_on);

}  // namespace delvox
