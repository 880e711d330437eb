#include "oracle/poisson_thinning.h"

#include <algorithm>
#include <cmath>

#include "core/round.h"

namespace delvox {
namespace {

using Cube = std::array<std::int64_t, 3>;

/// Of cubes, in spacings. A ball of one spacing meets 7 of them, where it would meet 20 as wide as itself, and there are
/// few points in each.
constexpr double kWidth = 2;

Cube cube_of(const Point3& p, double width) {
  return {floor_to_int(p.x / width), floor_to_int(p.y / width), floor_to_int(p.z / width)};
}

Cube block_of(const Cube& cube) {
  return {cube[0] >> 2, cube[1] >> 2, cube[2] >> 2};
}

/// Neighbours in the order of their 2x2x2 cubes, which share a line of the cache with their likes.
std::size_t place_in_block(const Cube& cube) {
  const auto low = [&](int axis) { return static_cast<std::size_t>(cube[axis] & 1) << axis; };
  const auto high = [&](int axis) { return static_cast<std::size_t>(cube[axis] >> 1 & 1) << (axis + 3); };
  return low(0) | low(1) | low(2) | high(0) | high(1) | high(2);
}

/// Low bits for the place among neighbours, so that FlatHash keeps them together. Blocks with equal keys are one;
/// distances are always tested, so that costs time only.
std::uint64_t key_of(const Cube& c) {
  const auto bits = [](std::int64_t i, int from, int count) {
    return static_cast<std::uint64_t>(i) >> from & ((std::uint64_t{1} << count) - 1);
  };
  return bits(c[0], 0, 4) | bits(c[1], 0, 4) << 4 | bits(c[2], 0, 3) << 8 | bits(c[0], 4, 17) << 11 |
         bits(c[1], 4, 17) << 28 | bits(c[2], 3, 18) << 45;
}

}  // namespace

bool PoissonThinner::has_room(const Point3& p, double spacing) {
  // Points come in clusters: whoever refused the last one likely refuses this one.
  if (last_near_ != kEnd) {
    const Kept& last = kept_[last_near_];
    if (squared_distance(last.point, p) < std::min(spacing * spacing, last.squared_spacing)) return false;
  }
  return std::none_of(levels_.begin(), levels_.end(), [&](const Level& level) {
    return near_kept(level, p, std::min(spacing, level.width / kWidth));
  });
}

void PoissonThinner::add(const Point3& p, double spacing) {
  Level& own = level_of(spacing);
  std::uint32_t& first = own.first_in(cube_of(p, own.width));
  last_near_ = static_cast<std::uint32_t>(kept_.size());
  kept_.push_back({p, spacing * spacing, first});
  first = last_near_;
}

PoissonThinner::Level& PoissonThinner::level_of(double spacing) {
  int octave = 0;
  if (std::frexp(spacing / usual_, &octave) == 0.5) --octave;  // usual * 2^octave is the least that is not below spacing
  const auto known = std::find_if(levels_.begin(), levels_.end(), [&](const Level& l) { return l.octave == octave; });
  if (known != levels_.end()) return *known;
  return levels_.emplace_back(Level{octave, kWidth * std::max(std::ldexp(usual_, octave), spacing), {}, {}});
}

std::uint32_t& PoissonThinner::Level::first_in(const Cube& cube) {
  std::uint32_t& block = number[key_of(block_of(cube))];
  if (block == FlatHash::kAbsent) {
    block = static_cast<std::uint32_t>(blocks.size());
    blocks.emplace_back().fill(kEnd);
  }
  return blocks[block][place_in_block(cube)];
}

bool PoissonThinner::near_kept(const Level& level, const Point3& p, double reach) {
  const Cube home = cube_of(p, level.width);
  // Squared distances to the cubes before, at, and behind, along each axis. The own cube first: it refuses most.
  std::array<std::array<double, 3>, 3> gap;
  for (int axis = 0; axis < 3; ++axis) {
    const double into = p[axis] - static_cast<double>(home[axis]) * level.width, left = level.width - into;
    gap[axis] = {0, into * into, left * left};
  }
  // The cubes lie in up to 2x2x2 blocks, each looked up when it is first needed.
  const Cube corner = block_of({home[0] - 1, home[1] - 1, home[2] - 1});
  constexpr std::uint32_t kUnknown = FlatHash::kAbsent - 1;
  std::array<std::uint32_t, 8> blocks;
  blocks.fill(kUnknown);
  const auto first_in = [&](const Cube& cube) {
    const Cube at = block_of(cube);
    std::uint32_t& block = blocks[(at[0] - corner[0]) | (at[1] - corner[1]) << 1 | (at[2] - corner[2]) << 2];
    if (block == kUnknown) block = level.number.find(key_of(at));
    return block == FlatHash::kAbsent ? kEnd : level.blocks[block][place_in_block(cube)];
  };
  constexpr int kStep[3] = {0, -1, 1};
  const double squared_reach = reach * reach;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const double gap_jk = gap[2][k] + gap[1][j];
      if (gap_jk >= squared_reach) continue;
      for (int i = 0; i < 3; ++i) {
        if (gap_jk + gap[0][i] >= squared_reach) continue;
        const std::uint32_t first = first_in({home[0] + kStep[i], home[1] + kStep[j], home[2] + kStep[k]});
        if (near_in_list(first, p, squared_reach)) return true;
      }
    }
  }
  return false;
}

bool PoissonThinner::near_in_list(std::uint32_t first, const Point3& p, double squared_reach) {
  for (std::uint32_t i = first; i != kEnd; i = kept_[i].next) {
    if (squared_distance(kept_[i].point, p) >= std::min(squared_reach, kept_[i].squared_spacing)) continue;
    last_near_ = i;
    return true;
  }
  return false;
}

}  // namespace delvox
