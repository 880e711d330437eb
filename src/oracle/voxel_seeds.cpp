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
/// At most this many candidates for a crossing, where the spacing is below a voxel.
constexpr int kMostCopies = 64;

std::uint64_t hash_edge(const CrossedEdge& edge, std::uint64_t salt) {
  const std::uint64_t place =
      static_cast<std::uint64_t>(edge.sample[0]) | static_cast<std::uint64_t>(edge.sample[1]) << 21 |
      static_cast<std::uint64_t>(edge.sample[2]) << 42 | static_cast<std::uint64_t>(edge.axis) << 62;
  return mix_hash(mix_hash(place) ^ salt);
}

/// Walks over the crossings brick by brick and keeps nothing of them but the seeds.
class SeedMaker {
 public:
  SeedMaker(const BrickField& field, const Affine3& grid_to_world, const SizeField& size, const GoOn& go_on)
      : field_(field),
        to_world_(grid_to_world),
        size_(size),
        go_on_(go_on),
        found_(find_components(field, go_on)),
        thinner_(kDensity * size.minimum()) {
    for (int axis = 0; axis < 3; ++axis) steps_[axis] = norm(to_world_.column(axis));
    voxel_ = std::min({steps_.x, steps_.y, steps_.z});
    least_spacing_ = kDensity * size.minimum();
  }

  Seeds run() {
    seeds_.components = found_.components.size();
    const std::uint32_t* component = found_.of_crossing.data();
    field_.for_each_mixed_brick([&](const std::array<int, 3>& brick) {
      if (stopped_) return;
      for_each_crossed_edge(field_, brick, BrickEdges(field_, brick),
                            [&](const CrossedEdge& edge) { visit(edge, *component++); });
    });
    return std::move(seeds_);
  }

 private:
  void visit(const CrossedEdge& edge, std::uint32_t number) {
    const SurfaceComponents::Component& component = found_.components[number];
    if (component.crossings <= kFewCrossings) {
      seeds_.points.push_back(jittered(edge, 0, std::min(0.5, 0.05 * diagonal(component) / voxel_)));
      return;
    }
    // Most are turned away by their hash, if the spacing is wide, before anything is computed.
    const double extent = diagonal(component), draw = unit_interval(hash_edge(edge, 0));
    if (!drawn(draw, std::min(least_spacing_, extent / 3), extent) || stopped_) return;
    const Point3 crossing = edge.point(field_.level());
    const Point3 world = to_world_(crossing);
    const double spacing = std::min(kDensity * size_(world), extent / 3);
    if (!size_.constant() && !drawn(draw, spacing, extent)) return;
    stopped_ = !go_on_();
    add_seeds(edge, world, spacing);
  }

  /// Length in world of a component's box.
  double diagonal(const SurfaceComponents::Component& component) const {
    const Vector3 size = component.box.max - component.box.min;
    return norm({steps_.x * size.x, steps_.y * size.y, steps_.z * size.z});
  }

  double per_voxel(double spacing) const { return voxel_ / (0.9 * spacing); }

  /// Whether a crossing is a candidate; all are where the component is not much larger than the spacing.
  bool drawn(double draw, double spacing, double extent) const {
    return spacing >= 0.1 * extent || draw <= kCandidatesPerSquare * per_voxel(spacing) * per_voxel(spacing);
  }

  void add_seeds(const CrossedEdge& edge, const Point3& world, double spacing) {
    const double squared = per_voxel(spacing) * per_voxel(spacing);
    const int copies = static_cast<int>(std::clamp(std::ceil(squared), 1.0, double(kMostCopies)));
    if (spacing > 2 * voxel_) {
      // Jittered after thinning: few are kept. Moved by more than a small part of their spacing, some would come so
      // near to each other that angles ask for many more vertices around them.
      if (thinner_.keep(world, spacing))
        seeds_.points.push_back(jittered(edge, 0, std::min(0.5, 0.07 * spacing / voxel_)));
      return;
    }
    const double reach = spacing < voxel_ ? 0.5 : 0.25 * spacing / voxel_;
    for (int copy = 0; copy < copies; ++copy) {
      const Point3 p = jittered(edge, copy, reach);
      if (thinner_.keep(to_world_(p), spacing)) seeds_.points.push_back(p);
    }
  }

  /// A crossing on a line parallel to the grid edge, moved sideways by up to `reach` by a hash of the edge; nearer to
  /// the edge if the first line misses the surface.
  Point3 jittered(const CrossedEdge& edge, int copy, double reach) const {
    constexpr int kAttempts = 4;
    for (int attempt = 0; attempt < kAttempts; ++attempt, reach *= 0.25) {
      const std::uint64_t h = hash_edge(edge, static_cast<std::uint64_t>(copy * kAttempts + attempt + 1));
      Point3 low{double(edge.sample[0]), double(edge.sample[1]), double(edge.sample[2])};
      low[(edge.axis + 1) % 3] += reach * (2 * unit_interval(h) - 1);
      low[(edge.axis + 2) % 3] += reach * (2 * unit_interval(mix_hash(h)) - 1);
      Point3 high = low;
      high[edge.axis] += 1;
      if (!field_.contains(low) || !field_.contains(high)) continue;
      const double value_low = field_.value(low), value_high = field_.value(high);
      if ((value_low > 0) == (value_high > 0)) continue;
      return crossing_on_line(low, edge.axis, value_low, value_high);
    }
    return edge.point(field_.level());
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

  const BrickField& field_;
  const Affine3& to_world_;
  const SizeField& size_;
  const GoOn& go_on_;
  SurfaceComponents found_;
  PoissonThinner thinner_;
  Vector3 steps_;  // world lengths of the voxel's edges
  double voxel_ = 1, least_spacing_ = 1;
  bool stopped_ = false;
  Seeds seeds_;
};

}  // namespace

Seeds voxel_seeds(const BrickField& field, const Affine3& grid_to_world, const SizeField& size, const GoOn& go_on) {
  return SeedMaker(field, grid_to_world, size, go_on).run();
}

}  // namespace delvox
