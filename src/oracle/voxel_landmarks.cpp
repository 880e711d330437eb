#include "oracle/voxel_landmarks.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "oracle/trilinear_cell.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;
using Wanted = std::function<bool(const Point3&)>;
constexpr int kBlock = BrickField::kBlock, kBrick = BrickField::kBrick;
constexpr auto& kStride = BrickField::kBlockStride;
constexpr std::uint32_t kNotYet = 0xffffffffu, kUnwanted = 0xfffffffeu;

class LandmarkFinder {
 public:
  LandmarkFinder(const BrickField& field, const Wanted& wanted)
      : field_(field), wanted_(wanted), level_(field.level()) {}

  Landmarks run(std::span<const Index3> bricks) {
    for (const Index3& brick : bricks) visit_brick(brick);
    return std::move(result_);
  }

 private:
  bool inside(const float* p) const { return *p > level_; }

  void visit_brick(const Index3& brick) {
    const float* block = field_.block(brick);
    brick_ = brick;
    samples_.fill(kNotYet);
    for (int axis = 0; axis < 3; ++axis) edge_done_[axis].fill(false), face_done_[axis].fill(false);
    for (int k = 0; k < kBrick; ++k) {
      for (int j = 0; j < kBrick; ++j) {
        for (int i = 0; i < kBrick; ++i) {
          const Index3 cell{i, j, k};
          if (!cell_exists(cell)) continue;
          const int base = (k * kBlock + j) * kBlock + i;
          if (crossed(block + base)) visit_cell(block, base, cell);
        }
      }
    }
  }

  bool cell_exists(const Index3& cell) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (brick_[axis] * kBrick + cell[axis] + 1 >= field_.size()[axis]) return false;
    }
    return true;
  }

  bool crossed(const float* p) const {
    const bool first = inside(p);
    for (int corner = 1; corner < 8; ++corner) {
      if (inside(p + offset(corner)) != first) return true;
    }
    return false;
  }

  static int offset(int corner) {
    return (corner & 1 ? kStride[0] : 0) + (corner & 2 ? kStride[1] : 0) + (corner & 4 ? kStride[2] : 0);
  }
  static Index3 moved(Index3 sample, int axis) {
    ++sample[axis];
    return sample;
  }
  Point3 place(const Index3& sample) const {
    return {double(brick_[0] * kBrick + sample[0]), double(brick_[1] * kBrick + sample[1]),
            double(brick_[2] * kBrick + sample[2])};
  }

  void visit_cell(const float* block, int base, const Index3& cell) {
    bool any_wanted = false;
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 sample{cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
      any_wanted |= add_sample(base + offset(corner), sample) != kUnwanted;
    }
    if (!any_wanted) return;
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 sample{cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
      const int at = base + offset(corner);
      for (int axis = 0; axis < 3; ++axis) {
        if (!(corner >> axis & 1)) add_edge(block, at, sample, axis);
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (!(corner >> u & 1) && !(corner >> v & 1)) add_face(block, at, sample, axis);
      }
    }
    add_body(block, base, cell);
  }

  std::uint32_t add_point(const Point3& p) {
    if (!wanted_(p)) return kUnwanted;
    result_.points.push_back(p);
    return static_cast<std::uint32_t>(result_.points.size() - 1);
  }

  std::uint32_t add_sample(int at, const Index3& sample) {
    if (samples_[at] == kNotYet) samples_[at] = add_point(place(sample));
    return samples_[at];
  }

  void add_edge(const float* block, int at, const Index3& sample, int axis) {
    if (std::exchange(edge_done_[axis][at], true)) return;
    if (inside(block + at) != inside(block + at + kStride[axis])) return;
    add_segment(add_sample(at, sample), add_sample(at + kStride[axis], moved(sample, axis)));
  }

  /// Joins the saddle of an ambiguous face to its side's corners: along a straight line from a bilinear saddle the
  /// function is monotone.
  void add_face(const float* block, int at, const Index3& sample, int normal) {
    if (std::exchange(face_done_[normal][at], true)) return;
    const int u = (normal + 1) % 3, v = (normal + 2) % 3;
    const std::array<const float*, 4> p{block + at, block + at + kStride[u], block + at + kStride[u] + kStride[v],
                                        block + at + kStride[v]};
    if (inside(p[0]) != inside(p[2]) || inside(p[1]) != inside(p[3]) || inside(p[0]) == inside(p[1])) return;
    const auto saddle = face_saddle(*p[0], *p[1], *p[2], *p[3]);
    if (!saddle) return;
    const double g0 = *p[0] - level_, g1 = *p[1] - level_, g2 = *p[2] - level_, g3 = *p[3] - level_;
    const bool even_inside = g0 > 0;
    const bool saddle_inside = even_inside ? g0 * g2 - g1 * g3 > 0 : g0 * g2 - g1 * g3 < 0;
    Point3 middle = place(sample);
    middle[u] += (*saddle)[0];
    middle[v] += (*saddle)[1];
    const std::uint32_t middle_index = add_point(middle);
    for (int corner = even_inside == saddle_inside ? 0 : 1; corner < 4; corner += 2) {
      Index3 end = sample;
      if (corner == 1 || corner == 2) ++end[u];
      if (corner >= 2) ++end[v];
      add_segment(middle_index, add_sample(static_cast<int>(p[corner] - block), end));
    }
  }

  void add_body(const float* block, int base, const Index3& cell) {
    std::array<float, 8> values;
    for (int corner = 0; corner < 8; ++corner) values[corner] = block[base + offset(corner)];
    for (const Point3& saddle : body_saddles(values)) {
      const bool saddle_inside = trilinear(values, saddle.x, saddle.y, saddle.z) > level_;
      const std::uint32_t saddle_index = add_point(place(cell) + saddle);
      for (int corner = 0; corner < 8; ++corner) {
        const Index3 end{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
        bool one_side = true;
        for (int step = 1; step <= 16 && one_side; ++step) {
          const Point3 q = saddle + (step / 16.0) * (Point3{double(end[0]), double(end[1]), double(end[2])} - saddle);
          one_side = (trilinear(values, q.x, q.y, q.z) > level_) == saddle_inside;
        }
        if (!one_side) continue;
        const Index3 sample{cell[0] + end[0], cell[1] + end[1], cell[2] + end[2]};
        add_segment(saddle_index, add_sample(base + offset(corner), sample));
      }
    }
  }

  void add_segment(std::uint32_t first, std::uint32_t last) {
    if (first != kUnwanted && last != kUnwanted) result_.links.push_back({first, last});
  }

  const BrickField& field_;
  const Wanted& wanted_;
  double level_;
  Index3 brick_{};
  std::array<std::uint32_t, BrickField::kBlockSize> samples_{};  // index of each sample's point, or one of the constants
  std::array<std::array<bool, BrickField::kBlockSize>, 3> edge_done_{}, face_done_{};
  Landmarks result_;
};

}  // namespace

Landmarks voxel_landmarks(const BrickField& field, const std::function<bool(const Point3&)>& wanted,
                          const GoOn& go_on) {
  constexpr std::size_t kBricksPerBatch = 512, kChunk = 8;
  std::vector<Index3> bricks;
  field.for_each_mixed_brick([&](const Index3& brick) { bricks.push_back(brick); });
  Landmarks all;
  for (std::size_t first = 0; first < bricks.size(); first += kBricksPerBatch) {
    const std::size_t count = std::min(kBricksPerBatch, bricks.size() - first);
    for (std::size_t n = 0; n < count; ++n) {
      if (!go_on()) return {};
    }
    const auto parts = map_chunks(count, kChunk, [&](std::size_t begin, std::size_t end) {
      return LandmarkFinder(field, wanted).run({&bricks[first + begin], end - begin});
    });
    for (const Landmarks& found : parts) {
      const auto before = static_cast<std::uint32_t>(all.points.size());
      all.points.insert(all.points.end(), found.points.begin(), found.points.end());
      for (const auto& [a, b] : found.links) all.links.push_back({before + a, before + b});
    }
  }
  return all;
}

}  // namespace delvox
