#include "volume/block_sides.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "volume/volume_impl.h"

namespace delvox {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;

Side side_of(const Leaf& leaf, const std::array<int, 3>& size, const LevelSet& level_set) {
  constexpr int kRow = static_cast<int>(Leaf::DIM), kSlice = kRow * kRow;  // k is the fastest
  const float* values = leaf.buffer().data();
  int inside = 0;
  for (int i = 0; i < size[0]; ++i) {
    for (int j = 0; j < size[1]; ++j) {
      const float* row = values + i * kSlice + j * kRow;
      for (int k = 0; k < size[2]; ++k) inside += level_set.inside(level_set.sign * row[k]) ? 1 : 0;
    }
  }
  return inside == 0 ? Side::kOutside : inside == size[0] * size[1] * size[2] ? Side::kInside : Side::kBoth;
}

}  // namespace

BlockSides block_sides(const Volume& volume, const LevelSet& level_set) {
  constexpr int kBlock = BlockSides::kBlock;
  static_assert(kBlock == static_cast<int>(Leaf::DIM));
  const std::array<int, 3>& dims = volume.dims();
  BlockSides result;
  for (int axis = 0; axis < 3; ++axis) result.counts[axis] = (dims[axis] - 1) / kBlock + 1;
  const int columns = result.counts[0], rows = result.counts[1];
  result.sides.resize(static_cast<std::size_t>(columns) * rows * result.counts[2]);
  tbb::parallel_for(0, rows * result.counts[2], [&](int row) {
    const auto accessor = volume.impl().grid->getConstAccessor();
    const int j = row % rows * kBlock, k = row / rows * kBlock;
    for (int column = 0; column < columns; ++column) {
      const int i = column * kBlock;
      const Leaf* leaf = accessor.probeConstLeaf(Coord(i, j, k));
      const auto of_tile = [&] {
        return level_set.inside(level_set.sign * accessor.getValue(Coord(i, j, k))) ? Side::kInside : Side::kOutside;
      };
      const std::array<int, 3> size{std::min(kBlock, dims[0] - i), std::min(kBlock, dims[1] - j),
                                    std::min(kBlock, dims[2] - k)};
      result.sides[static_cast<std::size_t>(row) * columns + column] =
          leaf != nullptr ? side_of(*leaf, size, level_set) : of_tile();
    }
  });
  return result;
}

Stretches stretches_near_surface(const BlockSides& sides, int j, int k, const std::array<int, 3>& dims) {
  const auto& n = sides.counts;
  const auto side_at = [&](int bi, int bj, int bk) {
    const bool in_image = bi >= 0 && bi < n[0] && bj >= 0 && bj < n[1] && bk >= 0 && bk < n[2];
    return in_image ? sides.at(bi, bj, bk) : Side::kOutside;
  };
  const auto near_surface = [&](int i) {
    const Side own = sides.at(i, j, k);
    if (own == Side::kBoth) return true;
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          if (side_at(i + di, j + dj, k + dk) != own) return true;
        }
      }
    }
    return false;
  };
  Stretches result;
  for (int i = 0; i < n[0]; ++i) {
    if (!near_surface(i)) continue;
    const int begin = i * BlockSides::kBlock, end = std::min(begin + BlockSides::kBlock, dims[0]);
    if (result.empty() || result.back().end != begin) result.push_back({begin, begin});
    result.back().end = end;
  }
  return result;
}

}  // namespace delvox
