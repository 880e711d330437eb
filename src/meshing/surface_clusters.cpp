#include "meshing/surface_clusters.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace delvox {
namespace {

constexpr int kBitsPerAxis = 20;

/// The cubes that hold a point, from the largest: three bits each.
std::uint64_t place_of(const Point3& p, const Point3& low, double width) {
  std::uint64_t place = 0;
  std::uint32_t index[3];
  constexpr double kCubes = 1 << kBitsPerAxis;
  for (int axis = 0; axis < 3; ++axis) {
    index[axis] = static_cast<std::uint32_t>(std::clamp((p[axis] - low[axis]) / width * kCubes, 0.0, kCubes - 1));
  }
  for (int bit = kBitsPerAxis - 1; bit >= 0; --bit) {
    for (int axis = 2; axis >= 0; --axis) place = place << 1 | (index[axis] >> bit & 1);
  }
  return place;
}

class Clusterer {
 public:
  using Placed = std::pair<std::uint64_t, std::uint32_t>;

  Clusterer(std::span<const SurfaceSample> samples, std::vector<Placed> placed)
      : samples_(samples), placed_(std::move(placed)) {}

  std::vector<SurfaceCluster> run() {
    if (placed_.empty()) return {};
    const SurfaceCluster all = make(0, placed_.size(), 3 * kBitsPerAxis);
    clusters_.push_back(all);
    return std::move(clusters_);
  }

 private:
  /// Of what lies in one cube, whose parts differ in bits below `bits` only.
  SurfaceCluster make(std::size_t begin, std::size_t end, int bits) {
    constexpr std::size_t kFew = 4;
    SurfaceCluster all = around(begin, end);
    if (end - begin == 1) return all;
    std::vector<SurfaceCluster> parts;
    if (end - begin <= kFew || bits == 0) {
      for (std::size_t i = begin; i < end; ++i) parts.push_back(around(i, i + 1));
    } else {
      while (part_end(begin, end, bits) == end && bits > 3) bits -= 3;
      for (std::size_t i = begin; i < end;) {
        const std::size_t next = part_end(i, end, bits);
        parts.push_back(make(i, next, bits - 3));
        i = next;
      }
    }
    all.first_part = static_cast<std::uint32_t>(clusters_.size());
    all.parts = static_cast<std::uint32_t>(parts.size());
    clusters_.insert(clusters_.end(), parts.begin(), parts.end());
    return all;
  }

  /// Where those that share the next three bits with the first end.
  std::size_t part_end(std::size_t begin, std::size_t end, int bits) const {
    const std::uint64_t cube = placed_[begin].first >> (bits - 3);
    const auto first = placed_.begin();
    return static_cast<std::size_t>(
        std::partition_point(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end),
                             [&](const Placed& p) { return p.first >> (bits - 3) == cube; }) -
        first);
  }

  /// The sample nearest to the mean stands for all.
  SurfaceCluster around(std::size_t begin, std::size_t end) const {
    Point3 mean;
    for (std::size_t i = begin; i < end; ++i) mean = mean + sample(i).point;
    mean = (1.0 / static_cast<double>(end - begin)) * mean;
    SurfaceCluster result;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      const double squared = squared_distance(sample(i).point, mean);
      if (squared >= least) continue;
      least = squared;
      result.point = sample(i).point;
    }
    for (std::size_t i = begin; i < end; ++i) {
      result.reach = std::max(result.reach, distance(sample(i).point, result.point) + sample(i).reach);
    }
    return result;
  }

  const SurfaceSample& sample(std::size_t i) const { return samples_[placed_[i].second]; }

  std::span<const SurfaceSample> samples_;
  std::vector<Placed> placed_;  // sorted
  std::vector<SurfaceCluster> clusters_;
};

}  // namespace

std::vector<SurfaceCluster> cluster(std::span<const SurfaceSample> samples, const Point3& center, double half_width) {
  const Point3 low = center - Vector3{half_width, half_width, half_width};
  std::vector<Clusterer::Placed> placed;
  placed.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    placed.emplace_back(place_of(samples[i].point, low, 2 * half_width), static_cast<std::uint32_t>(i));
  }
  std::sort(placed.begin(), placed.end());
  return Clusterer(samples, std::move(placed)).run();
}

}  // namespace delvox
