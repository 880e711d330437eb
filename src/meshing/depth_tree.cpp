#include "meshing/depth_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "oracle/brick_field.h"

namespace delvox {
namespace {

/// A leaf's edge is at most so many times the resolution or, if that is more, this part of its depth.
constexpr double kEdgePerResolution = 1.4, kEdgePerDepth = 0.7;
/// Clusters are small against the cubes that ask for them, and so against their distance.
constexpr double kReachPerEdge = 0.35;
/// Levels at the top that one thread builds before the rest is shared out.
constexpr int kTopLevels = 3;
constexpr int kMostLevels = 30;

struct Cube {
  Point3 center;  // relative to the root's
  double half = 0;
  int level = 0;

  Cube child(int octant) const {
    const double quarter = 0.5 * half;
    return {{center.x + (octant & 1 ? quarter : -quarter), center.y + (octant & 2 ? quarter : -quarter),
             center.z + (octant & 4 ? quarter : -quarter)},
            quarter,
            level + 1};
  }
};

}  // namespace

/// Some nodes and what hangs on them.
struct DepthTree::Part {
  /// A node whose children are still to be built.
  struct Task {
    Cube cube;
    std::vector<SurfaceCluster> clusters;
    std::size_t node;
  };
  std::vector<Node> nodes{kOutside};
  std::vector<Leaf> leaves;
  std::vector<Task> tasks;
  double squared_maximum = 0;
};

/// Hands to each child those of its parent's clusters that may hold what is nearest to some place in it, opened where
/// they are large for the child.
class DepthTree::Builder {
 public:
  Builder(const Oracle& oracle, const SizeField& resolution, const std::vector<SurfaceCluster>& all,
          const Point3& center)
      : oracle_(oracle), resolution_(resolution), all_(all), center_(center) {}

  /// The subtree of a cube; what lies below `last_level` is left as tasks.
  Part run(const Cube& cube, const std::vector<SurfaceCluster>& clusters, int last_level) {
    build(cube, clusters, 0, last_level);
    return std::move(part_);
  }

 private:
  void build(const Cube& cube, const std::vector<SurfaceCluster>& of_parent, std::size_t node, int last_level) {
    std::vector<SurfaceCluster> clusters;
    clusters.reserve(of_parent.size());
    for (const SurfaceCluster& c : of_parent) open(c, kReachPerEdge * 2 * cube.half, clusters);
    const SurfaceCluster nearest = cull(cube, clusters);
    const double depth = distance(to_world(cube.center), nearest.point);
    if (outside(cube, depth, nearest.reach)) return;  // kOutside
    const double finest = kEdgePerResolution * resolution_(to_world(cube.center));
    if (2 * cube.half <= std::max(finest, kEdgePerDepth * depth) || cube.level == kMostLevels) {
      part_.nodes[node] = ~static_cast<Node>(part_.leaves.size());
      part_.leaves.push_back(leaf(cube, clusters));
    } else if (cube.level == last_level) {
      part_.tasks.push_back({cube, std::move(clusters), node});
    } else {
      const std::size_t first = part_.nodes.size();
      part_.nodes[node] = static_cast<Node>(first);
      part_.nodes.resize(first + 8, kOutside);
      for (int octant = 0; octant < 8; ++octant) build(cube.child(octant), clusters, first + octant, last_level);
    }
  }

  Point3 to_world(const Point3& p) const { return center_ + p; }

  void open(const SurfaceCluster& cluster, double largest_reach, std::vector<SurfaceCluster>& out) const {
    if (!cluster.can_open() || cluster.reach <= largest_reach) {
      out.push_back(cluster);
      return;
    }
    for (std::uint32_t i = 0; i < cluster.parts; ++i) open(all_[cluster.first_part + i], largest_reach, out);
  }

  /// Returns the one nearest to the centre. Where the surface point nearest to a place is in some cluster, that
  /// cluster's squared distance is larger than the place's by its squared reach at most, were the surface flat, and
  /// the difference between two squared distances is linear in the cube.
  SurfaceCluster cull(const Cube& cube, std::vector<SurfaceCluster>& clusters) const {
    const Point3 center = to_world(cube.center);
    const SurfaceCluster* found = &clusters.front();
    double least = std::numeric_limits<double>::infinity();
    for (const SurfaceCluster& c : clusters) {
      const double squared = squared_distance(center, c.point);
      if (squared >= least) continue;
      least = squared;
      found = &c;
    }
    const SurfaceCluster nearest = *found;
    std::erase_if(clusters, [&](const SurfaceCluster& c) {
      constexpr double kNotFlat = 2;
      const Vector3 apart = c.point - nearest.point;
      const double change = 2 * cube.half * (std::abs(apart.x) + std::abs(apart.y) + std::abs(apart.z));
      return squared_distance(center, c.point) - least - change > kNotFlat * c.reach * c.reach;
    });
    return nearest;
  }

  /// Is the surface too far away to enter the cube, and the cube outside?
  bool outside(const Cube& cube, double distance, double reach) const {
    return distance > std::sqrt(3.0) * cube.half + 1.5 * reach && oracle_.label(to_world(cube.center)) == 0;
  }

  Leaf leaf(const Cube& cube, const std::vector<SurfaceCluster>& clusters) {
    Leaf result;
    result.fill(std::numeric_limits<float>::infinity());
    const Point3 center = to_world(cube.center);
    for (const SurfaceCluster& c : clusters) {
      const Vector3 change = 2 * cube.half * (center - c.point);
      const double at_center = squared_distance(center, c.point) - c.reach * c.reach;
      for (int corner = 0; corner < 8; ++corner) {
        const double at_corner = at_center + (corner & 1 ? change.x : -change.x) +
                                 (corner & 2 ? change.y : -change.y) + (corner & 4 ? change.z : -change.z);
        result[corner] = std::min(result[corner], static_cast<float>(at_corner));
      }
    }
    const double corner_distance = 3 * cube.half * cube.half;
    for (float value : result) part_.squared_maximum = std::max(part_.squared_maximum, value + corner_distance);
    return result;
  }

  const Oracle& oracle_;
  const SizeField& resolution_;
  const std::vector<SurfaceCluster>& all_;
  const Point3 center_;
  Part part_;
};

DepthTree::DepthTree(const Oracle& oracle, std::span<const SurfaceSample> samples, const SizeField& resolution) {
  if (samples.empty()) return;
  const Box3 box = oracle.bounds();
  center_ = midpoint(box.min, box.max);
  for (int axis = 0; axis < 3; ++axis) half_ = std::max(half_, box.max[axis] - center_[axis]);
  const std::vector<SurfaceCluster> clusters = cluster(samples, center_, half_);
  Part top = Builder(oracle, resolution, clusters, center_).run({{}, half_, 0}, {clusters.back()}, kTopLevels);
  nodes_ = std::move(top.nodes);
  leaves_ = std::move(top.leaves);
  double squared_maximum = top.squared_maximum;
  const auto parts = map_chunks(top.tasks.size(), 1, [&](std::size_t begin, std::size_t) {
    const Part::Task& task = top.tasks[begin];
    const auto own_oracle = oracle.clone();
    return Builder(*own_oracle, resolution, clusters, center_).run(task.cube, task.clusters, kMostLevels);
  });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    graft(parts[i], top.tasks[i].node);
    squared_maximum = std::max(squared_maximum, parts[i].squared_maximum);
  }
  maximum_ = std::sqrt(squared_maximum);
}

/// Puts what was built apart in the place of a node.
void DepthTree::graft(const Part& part, std::size_t node) {
  const auto nodes_before = static_cast<Node>(nodes_.size()) - 1, leaves_before = static_cast<Node>(leaves_.size());
  const auto moved = [&](Node n) { return n == kOutside ? n : n >= 0 ? n + nodes_before : n - leaves_before; };
  nodes_[node] = moved(part.nodes.front());
  for (std::size_t i = 1; i < part.nodes.size(); ++i) nodes_.push_back(moved(part.nodes[i]));
  leaves_.insert(leaves_.end(), part.leaves.begin(), part.leaves.end());
}

double DepthTree::operator()(const Point3& p) const {
  const Vector3 from_root = p - center_;
  const double farthest = std::max({std::abs(from_root.x), std::abs(from_root.y), std::abs(from_root.z)});
  if (nodes_.empty() || !(farthest <= half_)) return 0;
  Cube cube{{}, half_, 0};
  Node node = nodes_.front();
  while (node >= 0) {
    const int octant = (from_root.x > cube.center.x) | (from_root.y > cube.center.y) << 1 |
                       (from_root.z > cube.center.z) << 2;
    node = nodes_[static_cast<std::size_t>(node + octant)];
    cube = cube.child(octant);
  }
  if (node == kOutside) return 0;
  const Vector3 from_center = from_root - cube.center;
  const Leaf& leaf = leaves_[static_cast<std::size_t>(~node)];
  const double scale = 0.5 / cube.half;
  const double power = trilinear(leaf, 0.5 + scale * from_center.x, 0.5 + scale * from_center.y,
                                 0.5 + scale * from_center.z) + squared_norm(from_center);
  return std::sqrt(std::max(0.0, power));
}

}  // namespace delvox
