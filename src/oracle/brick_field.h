#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/page_array.h"
#include "delvox/core/geometry.h"
#include "delvox/volume/level_set.h"

namespace delvox {

/// Signed samples of a padded volume, flattened where the surface passes: a table of 8x8x8-voxel bricks, each all
/// outside, all inside, or mixed with a copied block of 9x9x9 samples. Coordinates are those of the padded grid:
/// sample (0,0,0) is the padding corner, voxel (i,j,k) of the image is sample (i+1,j+1,k+1).
class BrickField {
 public:
  static constexpr int kBrickBits = 3, kBrick = 1 << kBrickBits, kBlock = kBrick + 1, kBlockSize = kBlock * kBlock * kBlock;

  /// Steps along i, j, k inside a block.
  static constexpr std::array<int, 3> kBlockStride{1, kBlock, kBlock * kBlock};

  BrickField(const Volume& volume, const LevelSet& level_set);

  /// Number of samples along each axis, padding included.
  const std::array<int, 3>& size() const { return size_; }
  const std::array<int, 3>& brick_counts() const { return brick_counts_; }
  bool contains(const Point3& u) const {
    return u.x >= 0 && u.x <= size_[0] - 1 && u.y >= 0 && u.y <= size_[1] - 1 && u.z >= 0 && u.z <= size_[2] - 1;
  }

  enum class State { kOutside, kInside, kMixed };
  State state(const std::array<int, 3>& brick) const { return state_of(table_[brick_index(brick)]); }
  /// Samples of a mixed brick, i fastest.
  const float* block(const std::array<int, 3>& brick) const {
    return &blocks_[static_cast<std::size_t>(table_[brick_index(brick)]) * kBlockSize];
  }

  /// Calls visit(brick) for each mixed brick, first index fastest.
  template <class Visit>
  void for_each_mixed_brick(const Visit& visit) const {
    for (int layer = 0; layer < brick_counts_[2]; ++layer) for_each_mixed_brick(layer, visit);
  }
  /// As above, for those of one layer along the last index.
  template <class Visit>
  void for_each_mixed_brick(int layer, const Visit& visit) const;

  /// The eight samples around a cell, bit 0 of the index along x, bit 1 along y, bit 2 along z, if it lies in a mixed
  /// brick.
  struct CellSamples {
    std::array<float, 8> value;
    bool mixed_brick = false;
  };
  CellSamples cell_samples(const std::array<int, 3>& cell) const;
  /// Whether all of a cell's samples are on one side, and so the cell, or it is mixed.
  State cell_state(const std::array<int, 3>& cell) const;
  /// False only if no cell of the box between two is mixed, these included. Boxes wider than a brick are not looked
  /// into.
  bool may_be_mixed(const std::array<int, 3>& a, const std::array<int, 3>& b) const;
  /// Clamped below the last sample, so that points on the upper faces have a cell too. pre: contains(u).
  std::array<int, 3> cell_of(const Point3& u) const {
    return {std::min(static_cast<int>(u.x), size_[0] - 2), std::min(static_cast<int>(u.y), size_[1] - 2),
            std::min(static_cast<int>(u.z), size_[2] - 2)};
  }

  /// Trilinear value minus level. In pure bricks only its sign is known: a large number of that sign. pre: contains(u).
  double value(const Point3& u) const;
  bool inside(const Point3& u) const {
    const State side = cell_state(cell_of(u));
    return side == State::kMixed ? value(u) > 0 : side == State::kInside;
  }
  /// Whether values are known there. pre: contains(u).
  bool in_mixed_brick(const Point3& u) const { return entry_of(cell_of(u)) >= 0; }
  /// Gradient in grid coordinates, zero in pure bricks. pre: contains(u).
  Vector3 gradient(const Point3& u) const;
  double level() const { return level_; }
  /// The largest float below the level: a sample is inside if it is greater.
  float threshold() const;

 private:
  static constexpr std::int32_t kOutsideBrick = -1, kInsideBrick = -2;
  static State state_of(std::int32_t entry) {
    return entry == kOutsideBrick ? State::kOutside
           : entry == kInsideBrick ? State::kInside
                                   : State::kMixed;
  }
  std::size_t brick_index(const std::array<int, 3>& b) const {
    return (static_cast<std::size_t>(b[2]) * brick_counts_[1] + b[1]) * brick_counts_[0] + b[0];
  }
  std::int32_t entry_of(const std::array<int, 3>& cell) const {
    return table_[brick_index({cell[0] >> kBrickBits, cell[1] >> kBrickBits, cell[2] >> kBrickBits})];
  }
  /// The lowest of a cell's samples in its mixed brick.
  const float* lowest_sample(std::int32_t entry, const std::array<int, 3>& cell) const {
    constexpr int kInBrick = kBrick - 1;
    const int offset = ((cell[2] & kInBrick) * kBlock + (cell[1] & kInBrick)) * kBlock + (cell[0] & kInBrick);
    return &blocks_[static_cast<std::size_t>(entry) * kBlockSize + static_cast<std::size_t>(offset)];
  }
  /// A bit for each cell of a layer of a mixed brick, x fastest.
  struct LayerSides {
    std::uint64_t inside;  ///< all of its samples are
    std::uint64_t mixed;   ///< some are
  };
  bool any_mixed_in_brick(const std::array<int, 3>& brick, const std::array<int, 3>& low,
                          const std::array<int, 3>& high) const;
  void find_sides(const Volume& volume, const LevelSet& level_set);
  void find_cell_sides(const std::array<int, 3>& brick, LayerSides* layers) const;
  template <class Visit>
  void for_each_brick_in_parallel(const Visit& visit);

  double level_;
  std::array<int, 3> size_, brick_counts_;
  std::vector<std::int32_t> table_;  // per brick: number of its block, or one of the constants
  PageArray<float> blocks_;
  PageArray<LayerSides> cell_sides_;  // kBrick layers of each mixed brick: a line of the cache tells what eight samples do
};

template <class Visit>
void BrickField::for_each_mixed_brick(int layer, const Visit& visit) const {
  std::array<int, 3> brick{0, 0, layer};
  for (brick[1] = 0; brick[1] < brick_counts_[1]; ++brick[1]) {
    for (brick[0] = 0; brick[0] < brick_counts_[0]; ++brick[0]) {
      if (state(brick) == State::kMixed) visit(brick);
    }
  }
}

/// Trilinear interpolation of eight samples (bit 0 of the index along x) at (x, y, z) in [0, 1]^3.
template <class Samples>
double trilinear(const Samples& s, double x, double y, double z) {
  const double s00 = s[0] + x * (static_cast<double>(s[1]) - s[0]), s10 = s[2] + x * (static_cast<double>(s[3]) - s[2]);
  const double s01 = s[4] + x * (static_cast<double>(s[5]) - s[4]), s11 = s[6] + x * (static_cast<double>(s[7]) - s[6]);
  const double s0 = s00 + y * (s10 - s00), s1 = s01 + y * (s11 - s01);
  return s0 + z * (s1 - s0);
}

inline BrickField::State BrickField::cell_state(const std::array<int, 3>& cell) const {
  const std::int32_t entry = entry_of(cell);
  if (entry < 0) return state_of(entry);
  constexpr int kInBrick = kBrick - 1;
  const LayerSides& layer = cell_sides_[static_cast<std::size_t>(entry) * kBrick + (cell[2] & kInBrick)];
  const int bit = (cell[1] & kInBrick) * kBrick + (cell[0] & kInBrick);
  if ((layer.mixed >> bit & 1) != 0) return State::kMixed;
  return (layer.inside >> bit & 1) != 0 ? State::kInside : State::kOutside;
}

inline double BrickField::value(const Point3& u) const {
  constexpr double kFarFromLevel = 1e30;
  const std::array<int, 3> cell = cell_of(u);
  const std::int32_t entry = entry_of(cell);
  if (entry < 0) return entry == kInsideBrick ? kFarFromLevel : -kFarFromLevel;
  constexpr int kRow = kBlock, kSlice = kBlock * kBlock;
  const float* s = lowest_sample(entry, cell);
  const std::array<double, 8> corners{s[0],      s[1],          s[kRow],          s[kRow + 1],
                                      s[kSlice], s[kSlice + 1], s[kSlice + kRow], s[kSlice + kRow + 1]};
  return trilinear(corners, u.x - cell[0], u.y - cell[1], u.z - cell[2]) - level_;
}

}  // namespace delvox
