#include "delvox/meshing/feature_size.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/frame.h"
#include "core/hash.h"
#include "delaunay/restricted_delaunay.h"
#include "delvox/core/errors.h"

namespace delvox {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Point3> sample(const Oracle& oracle, double spacing, const GoOn& go_on) {
  std::vector<Point3> points = oracle.seeds(SizeField(spacing), go_on).points;
  if (points.empty()) throw NothingToMesh("the surface is empty: no point was found on it; choose another isovalue, formula or box");
  return points;
}

/// Moves points by a small part of their spacing: exact predicates would have to tell apart those of a sphere or a
/// plane.
void jitter(std::vector<Point3>& points, double spacing) {
  constexpr double kReach = 3e-4;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      points[i][axis] += kReach * spacing * (2 * unit_interval(mix_hash(3 * i + static_cast<std::size_t>(axis))) - 1);
    }
  }
}

/// Of a vertex of Del S, inside and outside; outside none where its Voronoi cell is unbounded: there it lies at
/// infinity.
void add_poles(const RestrictedDelaunay& delaunay, VertexId vertex, std::vector<Point3>& poles) {
  const Circumsphere* farthest[2] = {nullptr, nullptr};
  bool unbounded = false;
  for (CellId cell : delaunay.incident_cells(vertex)) {
    const auto& v = delaunay.vertices(cell);
    if (*std::min_element(v.begin(), v.end()) < Delaunay3::kCorners) {
      unbounded = true;
      continue;
    }
    const Circumsphere*& known = farthest[delaunay.label(cell) != 0 ? 1 : 0];
    const Circumsphere& sphere = delaunay.sphere(cell);
    if (known == nullptr || sphere.squared_radius > known->squared_radius) known = &sphere;
  }
  if (farthest[0] != nullptr && !unbounded) poles.push_back(farthest[0]->center);
  if (farthest[1] != nullptr) poles.push_back(farthest[1]->center);
}

/// The larger of the two principal curvatures of a surface at p, 1/mm.
double largest_curvature(const SmoothOracle& oracle, const Point3& p, double step) {
  const auto normal = [&](const Point3& q) {
    const Vector3 g = oracle.gradient(q);
    return (1 / norm(g)) * g;
  };
  const Vector3 n = normal(p);
  Vector3 u, v;
  find_frame(n, u, v);
  const Vector3 by_u = (0.5 / step) * (normal(p + step * u) - normal(p - step * u));
  const Vector3 by_v = (0.5 / step) * (normal(p + step * v) - normal(p - step * v));
  const double a = dot(by_u, u), b = 0.5 * (dot(by_u, v) + dot(by_v, u)), c = dot(by_v, v);
  return 0.5 * std::abs(a + c) + std::sqrt(0.25 * (a - c) * (a - c) + b * b);
}

}  // namespace

/// The points parted by the median along the longest side of their box, and so on; of each part the least length.
class FeatureSize::Tree {
 public:
  Tree(std::vector<Point3> points, std::vector<double> lengths) : nodes_(points.size()), least_(points.size()) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i] = {points[i], lengths[i], 0};
    build(0, nodes_.size());
  }

  double least(const Point3& p) const {
    double best = kInfinity;
    search(p, 0, nodes_.size(), best);
    return best;
  }

 private:
  struct Node {
    Point3 point;
    double length = 0;
    int axis = 0;
  };

  double build(std::size_t begin, std::size_t end) {
    if (begin == end) return kInfinity;
    Box3 box;
    for (std::size_t i = begin; i < end; ++i) box.extend(nodes_[i].point);
    const Vector3 side = box.max - box.min;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) { return nodes_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Node& a, const Node& b) { return a.point[axis] < b.point[axis]; });
    nodes_[middle].axis = axis;
    return least_[middle] = std::min({nodes_[middle].length, build(begin, middle), build(middle + 1, end)});
  }

  void search(const Point3& p, std::size_t begin, std::size_t end, double& best) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    if (least_[middle] >= best) return;
    const Node& node = nodes_[middle];
    best = std::min(best, node.length + distance(p, node.point));
    const double beyond = p[node.axis] - node.point[node.axis];
    const bool above = beyond > 0;
    search(p, above ? middle + 1 : begin, above ? end : middle, best);
    if (least_[middle] + std::abs(beyond) < best) search(p, above ? begin : middle + 1, above ? middle : end, best);
  }

  std::vector<Node> nodes_;
  std::vector<double> least_;  // of the part whose median a node is
};

FeatureSize::FeatureSize(std::vector<Point3> points, std::vector<double> lengths)
    : tree_(std::make_shared<const Tree>(std::move(points), std::move(lengths))) {}

double FeatureSize::operator()(const Point3& p) const {
  return tree_->least(p);
}

FeatureSize local_feature_size(const Oracle& oracle, double spacing, const GoOn& go_on) {
  RestrictedDelaunay delaunay(oracle);
  std::vector<Point3> points = sample(oracle, spacing, go_on);
  jitter(points, spacing);
  delaunay.insert_seeds(points, go_on);
  std::vector<Point3> poles;
  for (VertexId v = Delaunay3::kCorners; v < delaunay.vertex_capacity(); ++v) {
    if (delaunay.kind(v) == VertexKind::kSurface) add_poles(delaunay, v, poles);
  }
  if (poles.empty()) throw NothingToMesh("the surface is too small for its feature size to be told at that spacing");
  const std::size_t count = poles.size();
  return FeatureSize(std::move(poles), std::vector<double>(count, 0.0));
}

FeatureSize curvature_radius(const SmoothOracle& oracle, double spacing, const GoOn& go_on) {
  std::vector<Point3> points = sample(oracle, spacing, go_on);
  std::vector<double> radii;
  for (const Point3& p : points) {
    go_on();
    const double curvature = largest_curvature(oracle, p, 0.5 * spacing);
    radii.push_back(curvature > 0 ? 1 / curvature : kInfinity);  // also where the gradient vanishes
  }
  return FeatureSize(std::move(points), std::move(radii));
}

SizeField lipschitz(const SizeField& size, const Oracle& oracle, double spacing, const GoOn& go_on) {
  if (size.constant()) return size;
  std::vector<Point3> points = sample(oracle, spacing, go_on);
  std::vector<double> lengths;
  for (const Point3& p : points) lengths.push_back(size(p));
  const FeatureSize regular(std::move(points), std::move(lengths));
  return SizeField([size, regular](const Point3& p) { return std::min(size(p), regular(p)); }, size.minimum(),
                   size.maximum());
}

SizeField scaled(const FeatureSize& feature, double factor, double least, double most) {
  return SizeField([=](const Point3& p) { return std::clamp(factor * feature(p), least, most); }, least, most);
}

}  // namespace delvox
