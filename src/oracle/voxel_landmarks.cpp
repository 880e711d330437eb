#include "oracle/voxel_landmarks.h"

#include <utility>

#include "oracle/trilinear_cell.h"

namespace delvox {
namespace {

using Index3 = std::array<int, 3>;
constexpr int kBlock = BrickField::kBlock, kBrick = BrickField::kBrick;
constexpr auto& kStride = BrickField::kBlockStride;
/// Points per segment of the skeleton, its ends apart. On a grid edge the function is linear, so a neck is nowhere much
/// thinner than at the nearest of these.
constexpr int kPerSegment = 3;

class LandmarkFinder {
 public:
  explicit LandmarkFinder(const BrickField& field) : field_(field), level_(field.level()) {}

  std::vector<Point3> run() {
    field_.for_each_mixed_brick([this](const Index3& brick) { visit_brick(brick); });
    return std::move(points_);
  }

 private:
  bool inside(const float* p) const { return *p > level_; }

  void visit_brick(const Index3& brick) {
    const float* block = field_.block(brick);
    brick_ = brick;
    sample_done_.fill(false);
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
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 sample{cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1)};
      const int at = base + offset(corner);
      add_sample(at, sample);
      for (int axis = 0; axis < 3; ++axis) {
        if (!(corner >> axis & 1)) add_edge(block, at, sample, axis);
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (!(corner >> u & 1) && !(corner >> v & 1)) add_face(block, at, sample, axis);
      }
    }
    add_body(block + base, cell);
  }

  void add_sample(int at, const Index3& sample) {
    if (std::exchange(sample_done_[at], true)) return;
    points_.push_back(place(sample));
  }

  void add_edge(const float* block, int at, const Index3& sample, int axis) {
    if (std::exchange(edge_done_[axis][at], true)) return;
    if (inside(block + at) == inside(block + at + kStride[axis])) {
      add_segment(place(sample), place(moved(sample, axis)));
    }
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
    points_.push_back(middle);
    for (int corner = even_inside == saddle_inside ? 0 : 1; corner < 4; corner += 2) {
      Point3 end = place(sample);
      if (corner == 1 || corner == 2) end[u] += 1;
      if (corner >= 2) end[v] += 1;
      add_segment(middle, end);
    }
  }

  void add_body(const float* p, const Index3& cell) {
    std::array<float, 8> samples;
    for (int corner = 0; corner < 8; ++corner) samples[corner] = p[offset(corner)];
    for (const Point3& saddle : body_saddles(samples)) {
      const Point3 origin = place(cell);
      const bool saddle_inside = trilinear(samples, saddle.x, saddle.y, saddle.z) > level_;
      points_.push_back(origin + saddle);
      for (int corner = 0; corner < 8; ++corner) {
        const Point3 end{double(corner & 1), double(corner >> 1 & 1), double(corner >> 2 & 1)};
        bool one_side = true;
        for (int step = 1; step <= 16 && one_side; ++step) {
          const Point3 q = saddle + (step / 16.0) * (end - saddle);
          one_side = (trilinear(samples, q.x, q.y, q.z) > level_) == saddle_inside;
        }
        if (one_side) add_segment(origin + saddle, origin + end);
      }
    }
  }

  void add_segment(const Point3& a, const Point3& b) {
    for (int step = 1; step <= kPerSegment; ++step) {
      points_.push_back(a + (step / (kPerSegment + 1.0)) * (b - a));
    }
  }

  const BrickField& field_;
  double level_;
  Index3 brick_{};
  std::array<bool, BrickField::kBlockSize> sample_done_{};
  std::array<std::array<bool, BrickField::kBlockSize>, 3> edge_done_{}, face_done_{};
  std::vector<Point3> points_;
};

}  // namespace

std::vector<Point3> voxel_landmarks(const BrickField& field) { return LandmarkFinder(field).run(); }

}  // namespace delvox
