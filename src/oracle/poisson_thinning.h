#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/flat_hash.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// Thins a stream of points, greedily in the order they come: of those kept, every two p, q are at least
/// min(spacing(p), spacing(q)) apart, and none that was refused could be added. Holds the kept ones only.
class PoissonThinner {
 public:
  /// Works best where most spacings are `usual`. pre: usual > 0.
  explicit PoissonThinner(double usual) : usual_(usual) {}

  /// Whether the point is kept. pre: spacing > 0.
  bool keep(const Point3& p, double spacing) {
    if (!has_room(p, spacing)) return false;
    add(p, spacing);
    return true;
  }
  /// Whether keep() would keep the point.
  bool has_room(const Point3& p, double spacing);
  /// Keeps the point, whatever is near it.
  void add(const Point3& p, double spacing);

 private:
  static constexpr std::uint32_t kEnd = FlatHash::kAbsent;
  struct Kept {
    Point3 point;
    double squared_spacing;
    std::uint32_t next;  // in the same cube
  };
  using Cube = std::array<std::int64_t, 3>;
  /// The first kept point of each of 4x4x4 cubes: a surface fills a fair part of the blocks that it meets, so these
  /// take a fraction of the memory, and of the waiting for it, that hashing cube by cube takes.
  static constexpr int kBlock = 4;
  using Block = std::array<std::uint32_t, kBlock * kBlock * kBlock>;
  /// Kept points whose spacings are within one octave, in cubes twice as wide as the widest of them.
  struct Level {
    int octave;
    double width;  // of cubes
    FlatHash number;  // of a block
    std::vector<Block> blocks;

    std::uint32_t& first_in(const Cube& cube);
  };

  Level& level_of(double spacing);
  bool near_kept(const Level& level, const Point3& p, double reach);
  bool near_in_list(std::uint32_t first, const Point3& p, double squared_reach);

  double usual_;
  std::vector<Level> levels_;
  std::vector<Kept> kept_;
  std::uint32_t last_near_ = kEnd;
};

}  // namespace delvox
