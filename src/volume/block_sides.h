#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delvox/volume/level_set.h"

namespace delvox {

/// On which side of an isosurface the samples of a block lie.
enum class Side : std::uint8_t { kOutside, kInside, kBoth };

/// The sides of the blocks of 8x8x8 voxels that a volume is stored in; from (0, 0, 0), those at the upper end cut short.
struct BlockSides {
  static constexpr int kBlock = 8;
  std::array<int, 3> counts;  ///< of blocks along i, j, k
  std::vector<Side> sides;    ///< i fastest
  Side at(int i, int j, int k) const {
    return sides[(static_cast<std::size_t>(k) * counts[1] + j) * counts[0] + i];
  }
};
/// Looks at the samples of those blocks only that are not stored as one value.
BlockSides block_sides(const Volume& volume, const LevelSet& level_set);

/// Voxels [begin, end) along i.
struct Stretch {
  int begin, end;
};
using Stretches = std::vector<Stretch>;
/// The blocks of row (j, k) that have a neighbour, or are, on another side than theirs, those beyond the image being
/// outside: elsewhere no cell has samples of both signs. Ascending, with voxels between any two.
Stretches stretches_near_surface(const BlockSides& sides, int j, int k, const std::array<int, 3>& dims);

}  // namespace delvox
