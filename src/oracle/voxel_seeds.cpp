#include "oracle/voxel_seeds.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "oracle/bracketed_root.h"
#include "oracle/poisson_thinning.h"
#include "oracle/surface_crossings.h"

namespace delvox {
namespace {

/// Seeds lie this much denser than the wanted spacing, so that refinement starts from a nearly finished sample.
constexpr double kDensity = 0.9;
/// Candidates per square of the spacing that thinning starts from; more would hardly fill the gaps any better.
constexpr double kCandidatesPerSquare = 6;
/// A component keeps all its crossings if it has no more than this.
constexpr std::size_t kFewCrossings = 24;

struct ComponentExtent {
  Box3 box;  // world
  std::size_t crossings = 0;
};

std::uint64_t hash_edge(const GridCrossing& c, std::uint64_t salt) {
  std::uint64_t h = salt;
  for (int entry : c.sample) h = mix_hash(h ^ static_cast<std::uint64_t>(entry));
  return mix_hash(h ^ static_cast<std::uint64_t>(c.axis));
}

class SeedMaker {
 public:
  SeedMaker(const BrickField& field, const Affine3& grid_to_world, const Spacing& spacing)
      : field_(field), to_world_(grid_to_world), spacing_(spacing), found_(find_crossings(field)) {
    voxel_ = std::min({norm(to_world_.column(0)), norm(to_world_.column(1)), norm(to_world_.column(2))});
    measure_components();
  }

  Seeds run() {
    collect_candidates();
    Seeds seeds;
    seeds.components = found_.components;
    for (std::uint32_t index : thin_poisson(spaced_)) {
      const Candidate& candidate = candidates_[index];
      seeds.points.push_back(candidate.placed ? candidate.grid_point : jittered(candidate));
    }
    return seeds;
  }

 private:
  struct Candidate {
    std::uint32_t crossing;
    std::uint32_t copy;   // several candidates per crossing where the spacing is below a voxel
    Point3 grid_point;
    bool placed;          // already jittered
    double spacing;       // world
    std::uint64_t order;
  };

  void measure_components() {
    extents_.resize(found_.components);
    for (const GridCrossing& c : found_.crossings) {
      extents_[c.component].box.extend(to_world_(c.point()));
      ++extents_[c.component].crossings;
    }
  }

  double wanted_spacing(const GridCrossing& c, const Point3& world) const {
    const ComponentExtent& extent = extents_[c.component];
    const double wanted = kDensity * spacing_(world);
    // All crossings of a speck: thinned to a third of its size it could lose the very points that span it.
    if (extent.crossings <= kFewCrossings) return std::min(wanted, 1e-3 * extent.box.diagonal());
    return std::min(wanted, extent.box.diagonal() / 3);
  }

  void collect_candidates() {
    for (std::uint32_t index = 0; index < found_.crossings.size(); ++index) {
      const GridCrossing& c = found_.crossings[index];
      const double spacing = wanted_spacing(c, to_world_(c.point()));
      const bool speck = extents_[c.component].crossings <= kFewCrossings;
      const double per_voxel = voxel_ / (0.9 * spacing);
      const bool large = spacing < 0.1 * extents_[c.component].box.diagonal();
      if (large && unit_interval(hash_edge(c, 0)) > kCandidatesPerSquare * per_voxel * per_voxel) continue;
      const int copies = speck ? 1 : std::clamp(static_cast<int>(std::ceil(per_voxel * per_voxel)), 1, 64);
      for (std::uint32_t copy = 0; copy < static_cast<std::uint32_t>(copies); ++copy) {
        Candidate candidate{index, copy, c.point(), false, spacing, hash_edge(c, copy)};
        if (copies > 1) {
          candidate.grid_point = jittered(candidate);
          candidate.placed = true;
        }
        candidates_.push_back(candidate);
      }
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return a.order != b.order ? a.order < b.order
                                : std::pair(a.crossing, a.copy) < std::pair(b.crossing, b.copy);
    });
    for (const Candidate& c : candidates_) spaced_.push_back({to_world_(c.grid_point), c.spacing});
  }

  /// A crossing on a line parallel to the grid edge, moved sideways by a hash of the edge; nearer to the edge if the
  /// first line misses the surface.
  Point3 jittered(const Candidate& candidate) const {
    const GridCrossing& c = found_.crossings[candidate.crossing];
    const bool several = candidate.copy > 0 || candidate.spacing < voxel_;
    double reach = several ? 0.5 : std::min(0.5, 0.25 * candidate.spacing / voxel_);
    if (extents_[c.component].crossings <= kFewCrossings) reach = std::min(reach, 0.05 * grid_extent(c.component));
    for (std::uint64_t attempt = 0; attempt < 4; ++attempt, reach *= 0.25) {
      const std::uint64_t h = hash_edge(c, mix_hash(candidate.copy * 4 + attempt + 1));
      Point3 low{double(c.sample[0]), double(c.sample[1]), double(c.sample[2])};
      low[(c.axis + 1) % 3] += reach * (2 * unit_interval(h) - 1);
      low[(c.axis + 2) % 3] += reach * (2 * unit_interval(mix_hash(h)) - 1);
      Point3 high = low;
      high[c.axis] += 1;
      if (!field_.contains(low) || !field_.contains(high)) continue;
      const double value_low = field_.value(low), value_high = field_.value(high);
      if ((value_low > 0) == (value_high > 0)) continue;
      return crossing_on_line(low, c.axis, value_low, value_high);
    }
    return c.point();
  }

  Point3 crossing_on_line(const Point3& low, int axis, double value_low, double value_high) const {
    const auto at = [&](double t) {
      Point3 p = low;
      p[axis] += t;
      return p;
    };
    const double scale = std::abs(field_.level()) + 1e-30;
    return at(bracketed_root([&](double t) { return field_.value(at(t)); }, 0, value_low, 1, value_high, scale));
  }

  double grid_extent(std::uint32_t component) const { return extents_[component].box.diagonal() / voxel_; }

  const BrickField& field_;
  const Affine3& to_world_;
  const Spacing& spacing_;
  GridCrossings found_;
  double voxel_ = 1;
  std::vector<ComponentExtent> extents_;
  std::vector<Candidate> candidates_;
  std::vector<SpacedPoint> spaced_;
};

}  // namespace

Seeds voxel_seeds(const BrickField& field, const Affine3& grid_to_world, const Spacing& spacing) {
  return SeedMaker(field, grid_to_world, spacing).run();
}

}  // namespace delvox
