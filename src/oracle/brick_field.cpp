#include "oracle/brick_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delvox {
namespace {

/// Copies the 9x9x9 samples of one brick out of a slab; beyond the padded grid the last sample repeats.
bool copy_block(const float* slab, const std::array<int, 3>& slab_size, int begin_i, int begin_j, double level,
                float* block) {
  bool any_inside = false, any_outside = false;
  for (int k = 0; k < BrickField::kBlock; ++k) {
    const int kk = std::min(k, slab_size[2] - 1);
    for (int j = 0; j < BrickField::kBlock; ++j) {
      const int jj = std::min(begin_j + j, slab_size[1] - 1);
      const float* row = slab + (static_cast<std::size_t>(kk) * slab_size[1] + jj) * slab_size[0];
      for (int i = 0; i < BrickField::kBlock; ++i) {
        const float value = row[std::min(begin_i + i, slab_size[0] - 1)];
        any_inside |= value > level;
        any_outside |= !(value > level);
        *block++ = value;
      }
    }
  }
  return any_inside && any_outside;
}

}  // namespace

BrickField::BrickField(const Volume& volume, const LevelSet& level_set) : level_(level_set.level) {
  for (int axis = 0; axis < 3; ++axis) {
    size_[axis] = volume.dims()[axis] + 2;
    brick_counts_[axis] = (size_[axis] - 1 + kBrick - 1) / kBrick;
  }
  table_.reserve(static_cast<std::size_t>(brick_counts_[0]) * brick_counts_[1] * brick_counts_[2]);
  std::vector<float> slab(static_cast<std::size_t>(size_[0]) * size_[1] * kBlock);
  for (int brick_k = 0; brick_k < brick_counts_[2]; ++brick_k) {
    const int begin_k = brick_k * kBrick;
    const std::array<int, 3> slab_size{size_[0], size_[1], std::min(kBlock, size_[2] - begin_k)};
    copy_padded_block(volume, level_set, {-1, -1, begin_k - 1}, slab_size, slab.data());
    add_slab(slab.data(), slab_size);
  }
  blocks_.shrink_to_fit();
}

void BrickField::add_slab(const float* slab, const std::array<int, 3>& slab_size) {
  std::array<float, kBlockSize> block;
  for (int j = 0; j < brick_counts_[1]; ++j) {
    for (int i = 0; i < brick_counts_[0]; ++i) {
      if (copy_block(slab, slab_size, i * kBrick, j * kBrick, level_, block.data())) {
        table_.push_back(static_cast<std::int32_t>(blocks_.size() / kBlockSize));
        blocks_.insert(blocks_.end(), block.begin(), block.end());
      } else {
        table_.push_back(block[0] > level_ ? kInsideBrick : kOutsideBrick);
      }
    }
  }
}

BrickField::CellSamples BrickField::cell_samples(const std::array<int, 3>& cell) const {
  CellSamples result;
  const std::int32_t entry = entry_of(cell);
  if (entry < 0) {
    result.inside = entry == kInsideBrick;
    return result;
  }
  result.mixed_brick = true;
  const float* s = lowest_sample(entry, cell);
  constexpr int kRow = kBlock, kSlice = kBlock * kBlock;
  result.value = {s[0],      s[1],          s[kRow],          s[kRow + 1],
                  s[kSlice], s[kSlice + 1], s[kSlice + kRow], s[kSlice + kRow + 1]};
  return result;
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
