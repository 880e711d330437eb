#include "oracle/voxel_seeds.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/hash.h"
#include "core/parallel.h"
#include "oracle/poisson_thinning.h"
#include "oracle/surface_crossings.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;

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

/// A point that becomes a seed unless thinning refuses it.
struct Candidate {
  CrossedEdge edge;
  std::uint32_t component;
  Point3 point;             // grid coordinates
  double spacing = 0;       // in world; 0: kept whatever is near
  double late_jitter = 0;   // once it is kept, moved off the edge by up to this; 0 if it was already
};

/// Some mixed bricks, and the number of the first of their crossings, and of the first beyond.
struct Chunk {
  std::size_t first_brick = 0, end_brick = 0, first_crossing = 0, end_crossing = 0;
};

/// Walks over the crossings brick by brick and keeps nothing of them but the seeds: candidates are made in parallel,
/// some chunks at a time, and thinned in the order of the crossings while the next are made.
class SeedMaker {
 public:
  SeedMaker(const BrickField& field, const Affine3& grid_to_world, const SizeField& size, const GoOn& go_on)
      : field_(field),
        to_world_(grid_to_world),
        size_(size),
        go_on_(go_on),
        found_(find_components(field, go_on)),
        thinner_(size.minimum()) {
    for (int axis = 0; axis < 3; ++axis) steps_[axis] = norm(to_world_.column(axis));
    voxel_ = std::min({steps_.x, steps_.y, steps_.z});
    least_spacing_ = size.minimum();
    for (const SurfaceComponents::Component& c : found_.components) {
      if (c.crossings > kFewCrossings) least_spacing_ = std::min(least_spacing_, diagonal(c) / 3);
    }
  }

  Seeds run() {
    seeds_.components = found_.components.size();
    const std::vector<Chunk> chunks = cut_into_chunks();
    Batch now, next;
    make(chunks, 0, now);
    tbb::task_group making;
    bool going_on = true;
    for (std::size_t first = kBatch; going_on && now.chunks > 0; first += kBatch) {
      making.run([&, first] { make(chunks, first, next); });
      going_on = thin(now);  // by this thread: go_on may be heard by the caller of the run
      making.wait();
      std::swap(now, next);
    }
    return std::move(seeds_);
  }

 private:
  static constexpr std::size_t kBatch = 8, kCandidatesPerChunk = 8192;
  /// Candidates of some chunks, in order. Used again and again: new memory has to be asked for page by page.
  struct Batch {
    std::array<std::vector<Candidate>, kBatch> candidates;
    std::size_t chunks = 0;
  };

  std::vector<Chunk> cut_into_chunks() {
    // A field of sizes may take its time: no more of it is asked between two questions whether to go on.
    const std::size_t most =
        size_.constant() ? kCandidatesPerChunk / static_cast<std::size_t>(copies_at(least_spacing_)) : 1;
    std::vector<Chunk> chunks;
    std::size_t crossings = 0;
    field_.for_each_mixed_brick([&](const Index3& brick) {
      if (chunks.empty() || crossings - chunks.back().first_crossing >= most) {
        chunks.push_back({bricks_.size(), bricks_.size(), crossings, crossings});
      }
      crossings += found_.in_brick[bricks_.size()];
      bricks_.push_back(brick);
      chunks.back().end_brick = bricks_.size();
      chunks.back().end_crossing = crossings;
    });
    return chunks;
  }

  void make(const std::vector<Chunk>& chunks, std::size_t first, Batch& batch) const {
    batch.chunks = std::min(kBatch, chunks.size() - std::min(first, chunks.size()));
    for_each_chunk(batch.chunks, 1,
                   [&](std::size_t n, std::size_t) { find_candidates(chunks[first + n], batch.candidates[n]); });
  }

  void find_candidates(const Chunk& chunk, std::vector<Candidate>& candidates) const {
    candidates.clear();
    const bool all_are = least_spacing_ <= 2 * voxel_;  // else most are turned away
    if (all_are) candidates.reserve((chunk.end_crossing - chunk.first_crossing) * copies_at(least_spacing_));
    const std::uint32_t* component = found_.of_crossing.data() + chunk.first_crossing;
    for (std::size_t n = chunk.first_brick; n < chunk.end_brick; ++n) {
      for_each_crossed_edge(field_, bricks_[n], BrickEdges(field_, bricks_[n]),
                            [&](const CrossedEdge& edge) { add_candidates(edge, *component++, candidates); });
    }
  }

  void add_candidates(const CrossedEdge& edge, std::uint32_t number, std::vector<Candidate>& out) const {
    const SurfaceComponents::Component& component = found_.components[number];
    const double extent = diagonal(component);
    if (component.crossings <= kFewCrossings) {
      out.push_back({edge, number, jittered(edge, 0, std::min(0.5, 0.05 * extent / voxel_))});
      return;
    }
    // Most are turned away by their hash, if the spacing is wide, before anything is computed.
    const double draw = unit_interval(hash_edge(edge, 0));
    if (!drawn(draw, std::min(size_.minimum(), extent / 3), extent)) return;
    const Point3 crossing = edge.point(field_.level());
    const double spacing = std::min(size_(to_world_(crossing)), extent / 3);
    if (!size_.constant() && !drawn(draw, spacing, extent)) return;
    if (spacing > 2 * voxel_) {
      // Jittered after thinning: few are kept. Moved by more than a small part of their spacing, some would come so
      // near to each other that angles ask for many more vertices around them.
      out.push_back({edge, number, crossing, spacing, std::min(0.5, 0.07 * spacing / voxel_)});
      return;
    }
    const double reach = spacing < voxel_ ? 0.5 : 0.25 * spacing / voxel_;
    for (int copy = 0; copy < copies_at(spacing); ++copy)
      out.push_back({edge, number, jittered(edge, copy, reach), spacing});
  }

  /// False if go_on said no.
  bool thin(const Batch& batch) {
    for (std::size_t n = 0; n < batch.chunks; ++n) {
      for (const Candidate& c : batch.candidates[n]) {
        if (!go_on_()) return false;
        if (c.spacing > 0 && !thinner_.keep(to_world_(c.point), c.spacing)) continue;
        seeds_.component_of.push_back(c.component);
        seeds_.points.push_back(c.late_jitter > 0 ? jittered(c.edge, 0, c.late_jitter) : c.point);
      }
    }
    return true;
  }

  /// Length in world of a component's box.
  double diagonal(const SurfaceComponents::Component& component) const {
    const Vector3 size = component.box.max - component.box.min;
    return norm({steps_.x * size.x, steps_.y * size.y, steps_.z * size.z});
  }

  /// Of 0.9 spacings: so many candidates leave few gaps.
  double per_voxel(double spacing) const { return voxel_ / (0.9 * spacing); }

  /// How many candidates a crossing gives where the spacing is at most two voxels.
  int copies_at(double spacing) const {
    const double squared = per_voxel(spacing) * per_voxel(spacing);
    return static_cast<int>(std::clamp(std::ceil(squared), 1.0, double(kMostCopies)));
  }

  /// Whether a crossing is a candidate; all are where the component is not much larger than the spacing.
  bool drawn(double draw, double spacing, double extent) const {
    return spacing >= 0.1 * extent || draw <= kCandidatesPerSquare * per_voxel(spacing) * per_voxel(spacing);
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
      if (!field_.contains(low)) continue;
      const Index3 cell = field_.cell_of(low);
      const BrickField::CellSamples samples = field_.cell_samples(cell);
      if (!samples.mixed_brick) continue;
      const auto value = [&](int end) {
        Point3 in_cell{low.x - cell[0], low.y - cell[1], low.z - cell[2]};
        in_cell[edge.axis] = end;
        return trilinear(samples.value, in_cell.x, in_cell.y, in_cell.z) - field_.level();
      };
      const double at_low = value(0), at_high = value(1);
      if ((at_low > 0) == (at_high > 0)) continue;
      low[edge.axis] += at_low / (at_low - at_high);  // along the axes the trilinear function is linear
      return low;
    }
    return edge.point(field_.level());
  }

  const BrickField& field_;
  const Affine3& to_world_;
  const SizeField& size_;
  const GoOn& go_on_;
  SurfaceComponents found_;
  std::vector<Index3> bricks_;  // the mixed ones
  PoissonThinner thinner_;
  Vector3 steps_;  // world lengths of the voxel's edges
  double voxel_ = 1, least_spacing_ = 1;
  Seeds seeds_;
};

}  // namespace

Seeds voxel_seeds(const BrickField& field, const Affine3& grid_to_world, const SizeField& size, const GoOn& go_on) {
  return SeedMaker(field, grid_to_world, size, go_on).run();
}

}  // namespace delvox
