#include "oracle/surface_crossings.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/hash.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;
constexpr int kBlock = BrickField::kBlock;
constexpr std::array<int, 3> kStride{1, kBlock, kBlock * kBlock};

/// Visits the base samples of all mixed bricks: the samples below each cell of the brick, padded grid included.
template <class Visit>
void for_each_base_sample(const BrickField& field, const Visit& visit) {
  const Index3& counts = field.brick_counts();
  const Index3& size = field.size();
  Index3 brick;
  for (brick[2] = 0; brick[2] < counts[2]; ++brick[2]) {
    for (brick[1] = 0; brick[1] < counts[1]; ++brick[1]) {
      for (brick[0] = 0; brick[0] < counts[0]; ++brick[0]) {
        if (field.state(brick) != BrickField::BrickState::kMixed) continue;
        const float* block = field.block(brick);
        for (int k = 0; k < BrickField::kBrick; ++k) {
          for (int j = 0; j < BrickField::kBrick; ++j) {
            for (int i = 0; i < BrickField::kBrick; ++i) {
              const Index3 sample{brick[0] * BrickField::kBrick + i, brick[1] * BrickField::kBrick + j,
                                  brick[2] * BrickField::kBrick + k};
              if (sample[0] >= size[0] || sample[1] >= size[1] || sample[2] >= size[2]) continue;
              visit(sample, block + (k * kBlock + j) * kBlock + i);
            }
          }
        }
      }
    }
  }
}

class CrossingFinder {
 public:
  explicit CrossingFinder(const BrickField& field) : field_(field), level_(field.level()) {}

  GridCrossings run() {
    for_each_base_sample(field_, [&](const Index3& s, const float* p) { add_edges(s, p); });
    parent_.resize(result_.crossings.size());
    std::iota(parent_.begin(), parent_.end(), 0u);
    for_each_base_sample(field_, [&](const Index3& s, const float* p) { join_on_faces(s, p); });
    number_components();
    return std::move(result_);
  }

 private:
  bool last(const Index3& sample, int axis) const { return sample[axis] + 1 >= field_.size()[axis]; }

  std::uint64_t key(Index3 sample, int axis) const {
    const auto& n = field_.size();
    return ((static_cast<std::uint64_t>(sample[2]) * n[1] + sample[1]) * n[0] + sample[0]) * 3 + axis;
  }

  void add_edges(const Index3& sample, const float* p) {
    const bool inside = p[0] > level_;
    for (int axis = 0; axis < 3; ++axis) {
      if (last(sample, axis)) continue;
      const float other = p[kStride[axis]];
      if ((other > level_) == inside) continue;
      index_.emplace(key(sample, axis), static_cast<std::uint32_t>(result_.crossings.size()));
      const double position = (level_ - p[0]) / (static_cast<double>(other) - p[0]);
      result_.crossings.push_back({sample, axis, position, 0});
    }
  }

  void join_on_faces(const Index3& sample, const float* p) {
    for (int normal = 0; normal < 3; ++normal) {
      const int u = (normal + 1) % 3, v = (normal + 2) % 3;
      if (last(sample, u) || last(sample, v)) continue;
      // Corners a (base), b (+u), c (+u+v), d (+v) and the four edges between them, in turn.
      const std::array<double, 4> g{p[0] - level_, p[kStride[u]] - level_, p[kStride[u] + kStride[v]] - level_,
                                    p[kStride[v]] - level_};
      const int inside = (g[0] > 0) + (g[1] > 0) + (g[2] > 0) + (g[3] > 0);
      if (inside == 0 || inside == 4) continue;
      Index3 plus_u = sample, plus_v = sample;
      ++plus_u[u];
      ++plus_v[v];
      const std::array<std::uint64_t, 4> edges{key(sample, u), key(plus_u, v), key(plus_v, u), key(sample, v)};
      join_face(g, edges);
    }
  }

  void join_face(const std::array<double, 4>& g, const std::array<std::uint64_t, 4>& edges) {
    std::array<int, 4> crossed;
    int count = 0;
    for (int e = 0; e < 4; ++e) {
      if ((g[e] > 0) != (g[(e + 1) % 4] > 0)) crossed[count++] = e;
    }
    if (count == 2) {
      join(edges[crossed[0]], edges[crossed[1]]);
      return;
    }
    // Corner i lies between edges i-1 and i. The curves cut off the corners of the side that the saddle is not on.
    const bool even_inside = g[0] > 0;
    const double saddle = g[0] * g[2] - g[1] * g[3];  // sign of the saddle value, times that of the even corners
    const bool saddle_inside = even_inside ? saddle > 0 : saddle < 0;
    const bool cut_off_even = even_inside != saddle_inside;
    for (int corner = cut_off_even ? 0 : 1; corner < 4; corner += 2) join(edges[(corner + 3) % 4], edges[corner]);
  }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::uint64_t a, std::uint64_t b) {
    const std::uint32_t ra = root(index_.at(a)), rb = root(index_.at(b));
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

  void number_components() {
    constexpr std::uint32_t kUnnamed = 0xffffffffu;
    std::vector<std::uint32_t> number(parent_.size(), kUnnamed);
    for (std::uint32_t i = 0; i < parent_.size(); ++i) {
      std::uint32_t& n = number[root(i)];
      if (n == kUnnamed) n = static_cast<std::uint32_t>(result_.components++);
      result_.crossings[i].component = n;
    }
  }

  struct KeyHash {
    std::size_t operator()(std::uint64_t key) const { return mix_hash(key); }
  };

  const BrickField& field_;
  double level_;
  GridCrossings result_;
  std::unordered_map<std::uint64_t, std::uint32_t, KeyHash> index_;
  std::vector<std::uint32_t> parent_;
};

}  // namespace

GridCrossings find_crossings(const BrickField& field) { return CrossingFinder(field).run(); }

}  // namespace delvox
