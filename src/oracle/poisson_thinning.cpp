#include "oracle/poisson_thinning.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/flat_hash.h"

namespace delvox {
namespace {

/// Candidates hashed into cubes. Whoever is kept strikes out its neighbours: that touches each candidate a few times,
/// where asking for each candidate whether a kept one is near would search all cubes around it.
class CandidateGrid {
 public:
  CandidateGrid(const std::vector<SpacedPoint>& candidates, double width)
      : candidates_(candidates), width_(width), next_(candidates.size(), kEnd), struck_(candidates.size(), 0) {
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
      std::uint32_t& first = first_[key(cube(candidates[i].point))];
      next_[i] = first;
      first = i;
    }
  }

  bool struck(std::uint32_t i) const { return struck_[i] != 0; }

  void strike_neighbours(std::uint32_t kept) {
    const Point3& p = candidates_[kept].point;
    const double reach = candidates_[kept].spacing;
    const Cube low = cube({p.x - reach, p.y - reach, p.z - reach}), high = cube({p.x + reach, p.y + reach, p.z + reach});
    for (std::int64_t k = low[2]; k <= high[2]; ++k) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t i = low[0]; i <= high[0]; ++i) strike_in({i, j, k}, kept);
      }
    }
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kEnd = FlatHash::kAbsent;

  Cube cube(const Point3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / width_)), static_cast<std::int64_t>(std::floor(p.y / width_)),
            static_cast<std::int64_t>(std::floor(p.z / width_))};
  }
  // Cubes with equal keys share a list; distances are always tested, so that costs time only.
  static std::uint64_t key(const Cube& c) {
    const auto part = [](std::int64_t i) { return static_cast<std::uint64_t>(i) & 0x1fffff; };
    return part(c[0]) | part(c[1]) << 21 | part(c[2]) << 42;
  }

  void strike_in(const Cube& c, std::uint32_t kept) {
    const SpacedPoint& centre = candidates_[kept];
    for (std::uint32_t i = first_.find(key(c)); i != kEnd; i = next_[i]) {
      const double reach = std::min(centre.spacing, candidates_[i].spacing);
      if (squared_distance(candidates_[i].point, centre.point) < reach * reach) struck_[i] = 1;
    }
  }

  const std::vector<SpacedPoint>& candidates_;
  double width_;
  FlatHash first_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint8_t> struck_;
};

}  // namespace

std::vector<std::uint32_t> thin_poisson(const std::vector<SpacedPoint>& candidates) {
  std::vector<std::uint32_t> kept;
  if (candidates.empty()) return kept;
  // Cubes as wide as the usual spacing: a few specks with tiny spacings must not make them narrow for all.
  std::vector<double> spacings;
  spacings.reserve(candidates.size());
  for (const SpacedPoint& c : candidates) spacings.push_back(c.spacing);
  const auto median = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), median, spacings.end());
  constexpr double kCubesPerLargest = 16;
  const double largest = *std::max_element(median, spacings.end());
  CandidateGrid grid(candidates, std::max(*median, largest / kCubesPerLargest));
  for (std::uint32_t index = 0; index < candidates.size(); ++index) {
    if (grid.struck(index)) continue;
    grid.strike_neighbours(index);
    kept.push_back(index);
  }
  return kept;
}

}  // namespace delvox
