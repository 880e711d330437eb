#include "oracle/poisson_thinning.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/flat_hash.h"

namespace delvox {
namespace {

/// Points whose spacing lies in one octave, hashed into cubes as wide as the octave's upper end.
class OctaveGrid {
 public:
  explicit OctaveGrid(double width) : width_(width) {}

  bool has_near(const Point3& p, double spacing) const {
    const double reach = std::min(spacing, width_);
    const auto low = cube({p.x - reach, p.y - reach, p.z - reach}), high = cube({p.x + reach, p.y + reach, p.z + reach});
    // Most candidates are refused by a point in their own cube.
    if (near_in(cube(p), p, spacing)) return true;
    for (std::int64_t k = low[2]; k <= high[2]; ++k) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t i = low[0]; i <= high[0]; ++i) {
          if (near_in({i, j, k}, p, spacing)) return true;
        }
      }
    }
    return false;
  }

  void add(const Point3& p, double spacing) {
    std::uint32_t& first = first_[key(cube(p))];
    entries_.push_back({p, spacing, first});
    first = static_cast<std::uint32_t>(entries_.size() - 1);
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kEnd = FlatHash::kAbsent;
  struct Entry {
    Point3 point;
    double spacing;
    std::uint32_t next;
  };

  Cube cube(const Point3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / width_)), static_cast<std::int64_t>(std::floor(p.y / width_)),
            static_cast<std::int64_t>(std::floor(p.z / width_))};
  }
  // Cubes with equal keys share a list; distances are always tested, so that costs time only.
  static std::uint64_t key(const Cube& c) {
    const auto part = [](std::int64_t i) { return static_cast<std::uint64_t>(i) & 0x1fffff; };
    return part(c[0]) | part(c[1]) << 21 | part(c[2]) << 42;
  }
  bool near_in(const Cube& c, const Point3& p, double spacing) const {
    for (std::uint32_t e = first_.find(key(c)); e != kEnd; e = entries_[e].next) {
      const double reach = std::min(spacing, entries_[e].spacing);
      if (squared_distance(entries_[e].point, p) < reach * reach) return true;
    }
    return false;
  }

  double width_;
  FlatHash first_;
  std::vector<Entry> entries_;
};

}  // namespace

std::vector<std::uint32_t> thin_poisson(const std::vector<SpacedPoint>& candidates) {
  double largest = 0;
  for (const SpacedPoint& c : candidates) largest = std::max(largest, c.spacing);
  std::vector<OctaveGrid> octaves;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t index = 0; index < candidates.size(); ++index) {
    const SpacedPoint& c = candidates[index];
    const std::size_t octave = static_cast<std::size_t>(std::max(0.0, std::floor(std::log2(largest / c.spacing))));
    while (octaves.size() <= octave) octaves.emplace_back(std::ldexp(largest, -static_cast<int>(octaves.size())));
    const bool refused = std::any_of(octaves.begin(), octaves.end(),
                                     [&](const OctaveGrid& grid) { return grid.has_near(c.point, c.spacing); });
    if (refused) continue;
    octaves[octave].add(c.point, c.spacing);
    kept.push_back(index);
  }
  return kept;
}

}  // namespace delvox
