#include "check/feature_checks.h"

#include <algorithm>
#include <cmath>

#include "check/triangle_tree.h"
#include "delvox/core/merge_points.h"
#include "delvox/core/sharp_edges.h"

namespace delvox::check {
namespace {

struct Segment {
  Point3 a, b;

  double share_of(const Point3& p) const {
    const Vector3 along = b - a;
    return std::clamp(dot(p - a, along) / squared_norm(along), 0.0, 1.0);
  }
  Point3 point(double share) const { return (1 - share) * a + share * b; }
  double distance_to(const Point3& p) const { return distance(p, point(share_of(p))); }
  double length() const { return distance(a, b); }
};

std::vector<Edge> edges_of(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

class FeatureSearch {
 public:
  FeatureSearch(const std::vector<Point3>& points, const SurfaceMesh& surface, double degrees, Precision precision)
      : points_(points), surface_(surface), covered_(collect(degrees)), tree_(surface_.points, flat_) {
    Box3 box;
    for (const Point3& p : surface_.points) box.extend(p);
    constexpr double kFollows = 2e-6;
    tolerance_ = kFollows * box.diagonal() + precision.displacement_mm;
  }

  KeptFeatures run(std::span<const Triangle> triangles) {
    find_touched(triangles);
    for (const Edge& edge : edges_of(triangles)) {
      if (result_.touched[edge[0]] != 0 && result_.touched[edge[1]] != 0 && follows(edge)) result_.edges.push_back(edge);
    }
    result_.sharp_edges = flat_.size();
    for (std::size_t s = 0; s < flat_.size(); ++s) measure(s);
    return std::move(result_);
  }

 private:
  struct Interval {
    double from, to;  // shares of a sharp edge
  };

  /// Sharp edges as triangles with two equal corners, for the tree.
  std::vector<std::vector<Interval>> collect(double degrees) {
    for (const SharpEdge& sharp : sharp_edges(surface_.points, surface_.triangles, degrees)) {
      flat_.push_back({sharp.ends[0], sharp.ends[1], sharp.ends[1]});
    }
    return std::vector<std::vector<Interval>>(flat_.size());
  }

  Segment sharp(std::size_t s) const { return {surface_.points[flat_[s][0]], surface_.points[flat_[s][1]]}; }

  Box3 around(const Point3& a, const Point3& b) const {
    Box3 box;
    box.extend(a);
    box.extend(b);
    const Vector3 margin{tolerance_, tolerance_, tolerance_};
    return {box.min - margin, box.max + margin};
  }

  void find_touched(std::span<const Triangle> triangles) {
    result_.touched.assign(points_.size(), 0);
    std::vector<std::uint8_t> met(points_.size(), 0);
    for (const Triangle& t : triangles) {
      for (std::uint32_t v : t) {
        if (met[v] != 0) continue;
        met[v] = 1;
        tree_.for_each_in(around(points_[v], points_[v]), [&](std::uint32_t s) {
          if (sharp(s).distance_to(points_[v]) <= tolerance_) result_.touched[v] = 1;
        });
      }
    }
  }

  /// Notes which parts of sharp edges lie along an edge of the mesh: both are straight, so that what lies between two
  /// places near it is near it.
  bool follows(const Edge& edge) {
    const Segment own{points_[edge[0]], points_[edge[1]]};
    bool any = false;
    tree_.for_each_in(around(own.a, own.b), [&](std::uint32_t s) {
      const Segment other = sharp(s);
      const double p = other.share_of(own.a), q = other.share_of(own.b);
      const Interval part{std::min(p, q), std::max(p, q)};
      const double off = std::max(own.distance_to(other.point(part.from)), own.distance_to(other.point(part.to)));
      if (!(part.to > part.from) || off > tolerance_) return;
      covered_[s].push_back(part);
      result_.distance_mm = std::max(result_.distance_mm, off);
      any |= (part.to - part.from) * other.length() > std::min(4 * tolerance_, 0.5 * own.length());
    });
    return any;
  }

  void measure(std::size_t s) {
    const Segment edge = sharp(s);
    const double length = edge.length();
    result_.length_mm += length;
    auto& parts = covered_[s];
    std::sort(parts.begin(), parts.end(), [](const Interval& a, const Interval& b) { return a.from < b.from; });
    parts.push_back({1, 1});
    double reached = 0;
    for (const Interval& part : parts) {
      const double gap = (part.from - reached) * length;
      if (gap > 4 * tolerance_) {
        result_.missing_mm += gap;
        result_.missing.add(edge.point(0.5 * (reached + part.from)));
      }
      reached = std::max(reached, part.to);
    }
  }

  const std::vector<Point3>& points_;
  const SurfaceMesh& surface_;
  double tolerance_ = 0;
  std::vector<Triangle> flat_;
  std::vector<std::vector<Interval>> covered_;  // per sharp edge; filled after flat_
  TriangleTree tree_;
  KeptFeatures result_;
};

}  // namespace

KeptFeatures find_features(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                           const SurfaceMesh& surface, double degrees, Precision precision) {
  const SurfaceMesh merged = with_equal_points_merged(surface);
  return FeatureSearch(points, merged, degrees, precision).run(triangles);
}

KeptFeatures named_features(std::size_t point_count, const std::vector<Edge>& edges) {
  KeptFeatures result;
  result.touched.assign(point_count, 0);
  for (const Edge& edge : edges) {
    for (std::uint32_t v : edge) result.touched[v] = 1;
    result.edges.push_back({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
  }
  std::sort(result.edges.begin(), result.edges.end());
  return result;
}

bool is_kept(const std::vector<Edge>& kept, std::uint32_t a, std::uint32_t b) {
  return std::binary_search(kept.begin(), kept.end(), Edge{std::min(a, b), std::max(a, b)});
}

}  // namespace delvox::check
