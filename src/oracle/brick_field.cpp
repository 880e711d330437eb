#include "oracle/brick_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/brick_edges.h"
#include "volume/block_sides.h"

namespace delvox {
namespace {

/// Copies the 9x9x9 samples of one brick; beyond the padded grid the last sample repeats.
void copy_brick(const Volume& volume, const LevelSet& level_set, const std::array<int, 3>& brick, float* block) {
  std::array<int, 3> begin, size;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = brick[axis] * BrickField::kBrick - 1;
    size[axis] = std::min(BrickField::kBlock, volume.dims()[axis] + 1 - begin[axis]);
  }
  copy_padded_block(volume, level_set, begin, size, block);
  if (size == std::array<int, 3>{BrickField::kBlock, BrickField::kBlock, BrickField::kBlock}) return;
  for (int k = BrickField::kBlock - 1; k >= 0; --k) {  // from the end: what is read lies before what is written
    for (int j = BrickField::kBlock - 1; j >= 0; --j) {
      for (int i = BrickField::kBlock - 1; i >= 0; --i) {
        block[(k * BrickField::kBlock + j) * BrickField::kBlock + i] =
            block[(std::min(k, size[2] - 1) * size[1] + std::min(j, size[1] - 1)) * size[0] + std::min(i, size[0] - 1)];
      }
    }
  }
}

/// The side of all samples of a brick if the blocks that it lies in tell: those from the one below it on, since brick b
/// has voxels 8 b - 1 to 8 b + 7.
Side side_by_blocks(const BlockSides& blocks, const std::array<int, 3>& brick, const std::array<int, 3>& dims) {
  std::array<int, 3> low, high;
  bool in_padding = false;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(brick[axis] - 1, 0);
    high[axis] = std::min(brick[axis], blocks.counts[axis] - 1);
    in_padding |= brick[axis] == 0 || brick[axis] * BrickField::kBrick + BrickField::kBrick - 1 >= dims[axis];
  }
  const Side first = blocks.at(low[0], low[1], low[2]);
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        if (blocks.at(i, j, k) != first) return Side::kBoth;
      }
    }
  }
  return first == Side::kInside && in_padding ? Side::kBoth : first;  // padding is outside
}

}  // namespace

BrickField::BrickField(const Volume& volume, const LevelSet& level_set) : level_(level_set.level) {
  for (int axis = 0; axis < 3; ++axis) {
    size_[axis] = volume.dims()[axis] + 2;
    brick_counts_[axis] = (size_[axis] - 1 + kBrick - 1) / kBrick;
  }
  find_sides(volume, level_set);
  std::int32_t blocks = 0;
  for (std::int32_t& entry : table_) {
    if (entry >= 0) entry = blocks++;
  }
  blocks_.grow_to(static_cast<std::size_t>(blocks) * kBlockSize);
  cell_sides_.grow_to(static_cast<std::size_t>(blocks) * kBrick);
  for_each_brick_in_parallel([&](const std::array<int, 3>& brick, std::int32_t& entry) {
    if (entry < 0) return;
    const auto number = static_cast<std::size_t>(entry);
    copy_brick(volume, level_set, brick, &blocks_[number * kBlockSize]);
    find_cell_sides(brick, &cell_sides_[number * kBrick]);
  });
}

template <class Visit>
void BrickField::for_each_brick_in_parallel(const Visit& visit) {
  tbb::parallel_for(0, brick_counts_[1] * brick_counts_[2], [&](int row) {
    std::array<int, 3> brick{0, row % brick_counts_[1], row / brick_counts_[1]};
    for (; brick[0] < brick_counts_[0]; ++brick[0]) visit(brick, table_[brick_index(brick)]);
  });
}

/// Marks each brick in the table as pure, or as mixed by a zero.
void BrickField::find_sides(const Volume& volume, const LevelSet& level_set) {
  const BlockSides blocks = block_sides(volume, level_set);
  table_.resize(static_cast<std::size_t>(brick_counts_[0]) * brick_counts_[1] * brick_counts_[2]);
  for_each_brick_in_parallel([&](const std::array<int, 3>& brick, std::int32_t& entry) {
    Side side = side_by_blocks(blocks, brick, volume.dims());
    if (side == Side::kBoth) {
      std::array<float, kBlockSize> block;
      copy_brick(volume, level_set, brick, block.data());
      const auto inside = std::count_if(block.begin(), block.end(), [&](float g) { return level_set.inside(g); });
      if (inside == 0) side = Side::kOutside;
      if (inside == kBlockSize) side = Side::kInside;
    }
    entry = side == Side::kBoth ? 0 : side == Side::kInside ? kInsideBrick : kOutsideBrick;
  });
}

void BrickField::find_cell_sides(const std::array<int, 3>& brick, LayerSides* layers) const {
  const BrickEdges edges(*this, brick);
  for (int layer = 0; layer < kBrick; ++layer) {
    std::uint64_t all = edges.inside(0, layer), any = all;
    for (int corner = 1; corner < 8; ++corner) {
      all &= edges.inside(corner, layer);
      any |= edges.inside(corner, layer);
    }
    layers[layer] = {all, any & ~all};
  }
}

BrickField::CellSamples BrickField::cell_samples(const std::array<int, 3>& cell) const {
  CellSamples result;
  const std::int32_t entry = entry_of(cell);
  if (entry < 0) return result;
  result.mixed_brick = true;
  const float* s = lowest_sample(entry, cell);
  constexpr int kRow = kBlock, kSlice = kBlock * kBlock;
  result.value = {s[0],      s[1],          s[kRow],          s[kRow + 1],
                  s[kSlice], s[kSlice + 1], s[kSlice + kRow], s[kSlice + kRow + 1]};
  return result;
}

bool BrickField::may_be_mixed(const std::array<int, 3>& a, const std::array<int, 3>& b) const {
  std::array<int, 3> low, high, brick;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(a[axis], b[axis]);
    high[axis] = std::max(a[axis], b[axis]);
    if (high[axis] - low[axis] > kBrick) return true;
  }
  for (brick[2] = low[2] >> kBrickBits; brick[2] <= high[2] >> kBrickBits; ++brick[2]) {
    for (brick[1] = low[1] >> kBrickBits; brick[1] <= high[1] >> kBrickBits; ++brick[1]) {
      for (brick[0] = low[0] >> kBrickBits; brick[0] <= high[0] >> kBrickBits; ++brick[0]) {
        if (any_mixed_in_brick(brick, low, high)) return true;
      }
    }
  }
  return false;
}

/// Of the box's cells, those of one brick. A layer's are asked for at once.
bool BrickField::any_mixed_in_brick(const std::array<int, 3>& brick, const std::array<int, 3>& low,
                                    const std::array<int, 3>& high) const {
  const std::int32_t entry = table_[brick_index(brick)];
  if (entry < 0) return false;
  std::array<int, 3> first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(low[axis] - brick[axis] * kBrick, 0);
    last[axis] = std::min(high[axis] - brick[axis] * kBrick, kBrick - 1);
  }
  constexpr std::uint64_t kAll = ~std::uint64_t{0}, kRows = kAll / 0xff;  // a bit for each row
  const std::uint64_t row = 0xffu >> (kBrick - 1 - last[0] + first[0]) << first[0];
  const std::uint64_t rows = kRows >> kBrick * (kBrick - 1 - last[1] + first[1]) << kBrick * first[1];
  std::uint64_t mixed = 0;
  for (int k = first[2]; k <= last[2]; ++k) {
    mixed |= cell_sides_[static_cast<std::size_t>(entry) * kBrick + static_cast<std::size_t>(k)].mixed;
  }
  return (mixed & row * rows) != 0;
}

float BrickField::threshold() const {
  const float nearest = static_cast<float>(level_);
  return nearest <= level_ ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

Vector3 BrickField::gradient(const Point3& u) const {
  const std::array<int, 3> cell = cell_of(u);
  const CellSamples samples = cell_samples(cell);
  if (!samples.mixed_brick) return {};
  const auto& s = samples.value;
  const double x = u.x - cell[0], y = u.y - cell[1], z = u.z - cell[2];
  const auto lerp2 = [](double a, double b, double c, double d, double p, double q) {
    return (a + p * (b - a)) * (1 - q) + (c + p * (d - c)) * q;
  };
  return {lerp2(double(s[1]) - s[0], double(s[3]) - s[2], double(s[5]) - s[4], double(s[7]) - s[6], y, z),
          lerp2(double(s[2]) - s[0], double(s[3]) - s[1], double(s[6]) - s[4], double(s[7]) - s[5], x, z),
          lerp2(double(s[4]) - s[0], double(s[5]) - s[1], double(s[6]) - s[2], double(s[7]) - s[3], x, y)};
}

}  // namespace delvox
