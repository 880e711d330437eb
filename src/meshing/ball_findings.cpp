#include <array>
#include <atomic>
#include <cmath>

#include "core/flat_hash.h"
#include "core/parallel.h"
#include "core/sort_by_key.h"
#include "meshing/surface_triangulation.h"

namespace delvox {
namespace {

/// Points sorted into cubes. They must outlive this.
class PointCubes {
 public:
  PointCubes(const std::vector<Point3>& points, double width) : points_(points), width_(width) {
    for (const Point3& p : points) box_.extend(p);
    in_order_.resize(points.size());
    constexpr std::size_t kChunk = 1 << 14;
    for_each_chunk(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) in_order_[i] = {key_of(cube_of(points[i])), static_cast<std::uint32_t>(i)};
    });
    sort_by_key(in_order_);
    for (std::uint32_t i = 0; i < in_order_.size(); ++i) {
      if (i == 0 || in_order_[i].key != in_order_[i - 1].key) first_[in_order_[i].key] = i;
    }
  }

  /// visit(point) for each that is nearer to the centre than that.
  template <class Visit>
  void for_each_within(const Point3& center, double squared_radius, const Visit& visit) const {
    const double radius = std::sqrt(squared_radius);
    const Cube low = cube_of(center - Vector3{radius, radius, radius});
    const Cube high = cube_of(center + Vector3{radius, radius, radius});
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
          const std::uint64_t key = key_of({x, y, z});
          for (std::size_t i = first_.find(key); i < in_order_.size() && in_order_[i].key == key; ++i) {
            const std::uint32_t p = in_order_[i].index;
            if (squared_distance(points_[p], center) < squared_radius) visit(p);
          }
        }
      }
    }
  }

 private:
  using Cube = std::array<std::int64_t, 3>;

  /// Those beyond the box of the points are empty.
  Cube cube_of(const Point3& p) const {
    Cube cube;
    for (int axis = 0; axis < 3; ++axis) {
      const double inside = std::min(std::max(p[axis], box_.min[axis]), box_.max[axis]);
      cube[axis] = static_cast<std::int64_t>((inside - box_.min[axis]) / width_);
    }
    return cube;
  }
  /// Cubes with equal keys are one; distances are always tested, so that costs time only.
  static std::uint64_t key_of(const Cube& cube) {
    constexpr int kBits = 21;
    constexpr std::uint64_t kMask = (1u << kBits) - 1;
    const auto bits = [](std::int64_t i) { return static_cast<std::uint64_t>(i) & kMask; };
    return bits(cube[0]) | bits(cube[1]) << kBits | bits(cube[2]) << (2 * kBits);
  }
  const std::vector<Point3>& points_;
  double width_;
  Box3 box_;
  std::vector<KeyedIndex> in_order_;
  FlatHash first_;  // of each cube, in in_order_
};

}  // namespace

SurfaceTriangulation::BallFindings SurfaceTriangulation::look_into_balls(const std::vector<Point3>& probes,
                                                                         double near) const {
  constexpr std::size_t kChunk = 4096;
  double sum = 0;
  for (const Face& face : faces_) sum += std::sqrt(face.squared_radius);
  std::vector<Point3> all = points_;
  all.insert(all.end(), probes.begin(), probes.end());
  const PointCubes cubes(all, 2 * sum / static_cast<double>(faces_.size()));
  std::vector<std::uint8_t> covered(probes.size(), 0);
  BallFindings found;
  found.occupied = gather_chunks<TriangleId>(faces_.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& list) {
    for (auto t = static_cast<TriangleId>(begin); t < end; ++t) {
      const Face& face = faces_[t];
      const Vector3 normal = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
      const double most = near * near * face.squared_radius * squared_norm(normal);
      bool occupied = false;
      // Probes may be vertices: these are on the balls around them.
      cubes.for_each_within(face.ball_center, face.squared_radius / kAHairLess, [&](std::uint32_t p) {
        if (p >= points_.size()) {
          const double height = dot(all[p] - corner(t, 0), normal);
          if (height * height > most) return;
          std::atomic_ref(covered[p - points_.size()]).store(1, std::memory_order_relaxed);
        } else {
          const bool own = p == face.corners[0] || p == face.corners[1] || p == face.corners[2];
          occupied |= !own && in_ball(points_[p], face);
        }
      });
      if (occupied) list.push_back(t);
    }
  });
  for (std::uint32_t i = 0; i < covered.size(); ++i) {
    if (covered[i] == 0) found.uncovered.push_back(i);
  }
  return found;
}

}  // namespace delvox
