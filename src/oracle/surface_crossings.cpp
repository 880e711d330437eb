#include "oracle/surface_crossings.h"

#include <algorithm>
#include <numeric>

#include "core/flat_hash.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;
constexpr auto& kStride = BrickField::kBlockStride;

class CrossingFinder {
 public:
  explicit CrossingFinder(const BrickField& field) : field_(field), level_(field.level()) {}

  GridCrossings run() {
    field_.for_each_mixed_sample([&](const Index3& s, const float* p) { add_edges(s, p); });
    parent_.resize(result_.crossings.size());
    std::iota(parent_.begin(), parent_.end(), 0u);
    field_.for_each_mixed_sample([&](const Index3& s, const float* p) { join_on_faces(s, p); });
    number_components();
    return std::move(result_);
  }

 private:
  bool last(const Index3& sample, int axis) const { return sample[axis] + 1 >= field_.size()[axis]; }

  /// Edges of one brick share all but the low bits, which the hash keeps together.
  std::uint64_t key(const Index3& sample, int axis) const {
    constexpr int kBits = 3, kMask = BrickField::kBrick - 1;
    static_assert(BrickField::kBrick == 1 << kBits);
    const auto& n = field_.brick_counts();
    const std::uint64_t brick = (static_cast<std::uint64_t>(sample[2] >> kBits) * (n[1] + 1) + (sample[1] >> kBits)) *
                                    (n[0] + 1) + (sample[0] >> kBits);
    const int local = ((sample[2] & kMask) << 2 * kBits | (sample[1] & kMask) << kBits | (sample[0] & kMask)) * 3 + axis;
    return brick << 11 | static_cast<std::uint64_t>(local);
  }

  void add_edges(const Index3& sample, const float* p) {
    const bool inside = p[0] > level_;
    for (int axis = 0; axis < 3; ++axis) {
      if (last(sample, axis)) continue;
      const float other = p[kStride[axis]];
      if ((other > level_) == inside) continue;
      index_[key(sample, axis)] = static_cast<std::uint32_t>(result_.crossings.size());
      const double position = (level_ - p[0]) / (static_cast<double>(other) - p[0]);
      result_.crossings.push_back({sample, axis, position, 0});
    }
  }

  void join_on_faces(const Index3& sample, const float* p) {
    for (int normal = 0; normal < 3; ++normal) {
      const int u = (normal + 1) % 3, v = (normal + 2) % 3;
      if (last(sample, u) || last(sample, v)) continue;
      // Corners a (base), b (+u), c (+u+v), d (+v) and the four edges between them, in turn.
      const std::array<float, 4> f{p[0], p[kStride[u]], p[kStride[u] + kStride[v]], p[kStride[v]]};
      const int inside = (f[0] > level_) + (f[1] > level_) + (f[2] > level_) + (f[3] > level_);
      if (inside == 0 || inside == 4) continue;
      const std::array<double, 4> g{f[0] - level_, f[1] - level_, f[2] - level_, f[3] - level_};
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
    const std::uint32_t ra = root(index_.find(a)), rb = root(index_.find(b));
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

  const BrickField& field_;
  double level_;
  GridCrossings result_;
  FlatHash index_;
  std::vector<std::uint32_t> parent_;
};

}  // namespace

GridCrossings find_crossings(const BrickField& field) { return CrossingFinder(field).run(); }

}  // namespace delvox
