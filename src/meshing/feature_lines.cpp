#include "meshing/feature_lines.h"

#include <algorithm>
#include <cmath>

namespace delvox {
namespace {

/// Where along the points of a line a place lies: the number of the point before it, not the last.
std::size_t piece_at(const FeatureLine& line, double along) {
  const auto after = std::upper_bound(line.at.begin() + 1, line.at.end() - 1, along);
  return static_cast<std::size_t>(after - line.at.begin()) - 1;
}

class LineMaker {
 public:
  LineMaker(const FeatureEdges& features, double tolerance)
      : features_(features), tolerance_(tolerance), at_(features.points.size()), used_(features.edges.size(), false) {
    for (std::uint32_t e = 0; e < features.edges.size(); ++e) {
      for (std::uint32_t end : features.edges[e].ends) at_[end].push_back(e);
    }
  }

  std::vector<FeatureLine> run() {
    for (std::uint32_t p = 0; p < at_.size(); ++p) {
      if (at_[p].size() == 2) continue;
      for (std::uint32_t e : at_[p]) {
        if (!used_[e]) cut(path_from(p, e));
      }
    }
    for (std::uint32_t e = 0; e < used_.size(); ++e) {
      if (!used_[e]) cut(begun_at_sharpest_turn(path_from(features_.edges[e].ends[0], e)));
    }
    return std::move(lines_);
  }

 private:
  struct Path {
    std::vector<std::uint32_t> points, edges;
  };

  const Point3& point(std::uint32_t p) const { return features_.points[p]; }

  /// On to where edges branch or end, or back to the start.
  Path path_from(std::uint32_t p, std::uint32_t e) {
    Path path{{p}, {}};
    while (!used_[e]) {
      used_[e] = true;
      const auto& ends = features_.edges[e].ends;
      p = ends[0] == p ? ends[1] : ends[0];
      path.points.push_back(p);
      path.edges.push_back(e);
      if (at_[p].size() == 2) e = at_[p][0] == e ? at_[p][1] : at_[p][0];
    }
    return path;
  }

  /// pre: the path is closed.
  Path begun_at_sharpest_turn(Path path) const {
    path.points.pop_back();
    const std::size_t n = path.points.size();
    std::size_t sharpest = 0;
    double least = 2;
    for (std::size_t i = 0; i < n; ++i) {
      const Vector3 u = point(path.points[i]) - point(path.points[(i + n - 1) % n]);
      const Vector3 v = point(path.points[(i + 1) % n]) - point(path.points[i]);
      const double cosine = dot(u, v) / std::sqrt(squared_norm(u) * squared_norm(v));
      if (cosine >= least) continue;
      least = cosine;
      sharpest = i;
    }
    const auto first = static_cast<std::ptrdiff_t>(sharpest);
    std::rotate(path.points.begin(), path.points.begin() + first, path.points.end());
    std::rotate(path.edges.begin(), path.edges.begin() + first, path.edges.end());
    path.points.push_back(path.points.front());
    return path;
  }

  /// Do the points between two of a path lie in their order on the straight between them?
  bool straight(const Path& path, std::size_t first, std::size_t last) const {
    const Point3& a = point(path.points[first]);
    const Vector3 along = point(path.points[last]) - a;
    const double squared_length = squared_norm(along);
    double before = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const Vector3 to = point(path.points[i]) - a;
      const double share = dot(to, along) / squared_length;
      if (!(share > before && share < 1) || !(norm(to - share * along) <= tolerance_)) return false;
      before = share;
    }
    return true;
  }

  void cut(const Path& path) {
    for (std::size_t first = 0, last; first + 1 < path.points.size(); first = last) {
      last = first + 1;
      while (last + 1 < path.points.size() && straight(path, first, last + 1)) ++last;
      FeatureLine line;
      line.ends = {path.points[first], path.points[last]};
      for (std::size_t i = first; i <= last; ++i) {
        const Point3& p = point(path.points[i]);
        line.at.push_back(i == first ? 0 : line.at.back() + distance(line.points.back(), p));
        line.points.push_back(p);
        if (i < last) line.edges.push_back(path.edges[i]);
      }
      lines_.push_back(std::move(line));
    }
  }

  const FeatureEdges& features_;
  const double tolerance_;
  std::vector<std::vector<std::uint32_t>> at_;  // edges at each point
  std::vector<bool> used_;
  std::vector<FeatureLine> lines_;
};

}  // namespace

Point3 FeatureLine::point(double along) const {
  const std::size_t i = piece_at(*this, along);
  const double share = (along - at[i]) / (at[i + 1] - at[i]);
  return share <= 0 ? points[i] : share >= 1 ? points[i + 1] : points[i] + share * (points[i + 1] - points[i]);
}

std::uint32_t FeatureLine::edge(double along) const { return edges[piece_at(*this, along)]; }

std::vector<FeatureLine> feature_lines(const FeatureEdges& features, double tolerance) {
  return LineMaker(features, tolerance).run();
}

}  // namespace delvox
