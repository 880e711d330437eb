#include "meshing/feature_rings.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace delvox {
namespace {

constexpr double kSharpestLeftAlone = 0.42;  // cosine of about 65 degrees
constexpr double kRow = 0.8660254037844386;  // of equilateral triangles
constexpr double kReach = 12;                // of rows, in lengths of the segment
constexpr double kSpacing = 0.8;             // of the triangles' edges
/// Of the edges of triangles on one facet to their distance from those on the other: such tets between them as have no
/// corner on the segment are within a radius-edge ratio of 2.
constexpr double kFlattest = 2.5;
constexpr double kSteepest = 0.8;  // sine of the angle between a line and a facet that it rises from, about 53 degrees

class Rings {
 public:
  Rings(const FeatureSegments& segments, const Oracle& oracle, bool solid, PoissonThinner& thinner)
      : segments_(segments), oracle_(oracle), solid_(solid), thinner_(thinner) {}

  std::vector<Point3> run(const GoOn& go_on) {
    const std::uint32_t count = segments_.segment_count();
    for (std::uint32_t s = 0; s < count && go_on(); ++s) {
      for (std::size_t end = 0; end < 2; ++end) add_under(s, end);
    }
    bool any = true;
    for (int row = 0; any; ++row) {
      any = false;
      for (std::uint32_t s = 0; s < count && go_on(); ++s) any |= add_row(s, row);
    }
    return std::move(points_);
  }

 private:
  /// False beyond the last row. Row 0 is as far from the segment as its own triangles are high; from there on triangles
  /// are smaller if the tets between the facets would be too flat.
  bool add_row(std::uint32_t segment, int row) {
    const FeatureEdges::Edge& edge = segments_.edge(segment);
    const double cosine = dot(edge.into[0], edge.into[1]);
    if (cosine < kSharpestLeftAlone) return false;
    // Of the distance from the edge, how far the facets are apart.
    const double apart = std::sqrt(std::max(1e-6, 2 - 2 * cosine));
    const double length = segments_.length(segment);
    int parts = 1;
    while (solid_ && length > parts * kFlattest * apart * kRow * length) parts *= 2;
    const double spacing = length / parts;
    const double reach = kRow * (length + row * spacing);
    if (reach > kReach * length || (reach - kRow * spacing) * apart > length) return false;
    const Edge& ends = segments_.segment(segment).ends;
    const Point3 &a = segments_.node(ends[0]), &b = segments_.node(ends[1]);
    // Steps of half a triangle's edge; of those every other is taken, in row 0 the middle one among them.
    for (int step = (row + parts) % 2; step <= 2 * parts; step += 2) {
      const double share = static_cast<double>(step) / (2 * parts);
      add_pair((1 - share) * a + share * b, reach, spacing, apart, edge);
    }
    return true;
  }

  void add_pair(const Point3& base, double reach, double spacing, double apart, const FeatureEdges::Edge& edge) {
    std::array<Point3, 2> pair;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto place = on_surface(base + reach * edge.into[side], 0.15 * apart * reach * edge.normals[side]);
      if (!place || segments_.encroached_by(*place) || !thinner_.has_room(*place, kSpacing * spacing)) return;
      pair[side] = *place;
    }
    for (const Point3& p : pair) {
      thinner_.add(p, kSpacing * spacing);
      points_.push_back(p);
    }
  }

  /// The node at one end of a segment, turned into the plane of each facet at a corner of its line that the line rises
  /// from at a small angle.
  void add_under(std::uint32_t segment, std::size_t end) {
    const Edge& ends = segments_.segment(segment).ends;
    const Point3& p = segments_.node(ends[end]);
    const double length = segments_.length(segment);
    for (std::uint32_t corner : segments_.line_ends(segments_.segment(segment).line)) {
      if (corner == ends[end]) continue;
      const Point3& c = segments_.node(corner);
      const double along = distance(p, c);
      for (std::uint32_t at : segments_.at(corner)) {
        for (const Vector3& normal : segments_.edge(at).normals) {
          const double rise = dot(p - c, normal) / along;
          if (std::abs(rise) > kSteepest || std::abs(rise) < 1e-3 || std::abs(rise) * along > length) continue;
          const Vector3 flat = p - c - rise * along * normal;
          const auto place = on_surface(c + (along / norm(flat)) * flat, 0.15 * rise * along * normal);
          if (!place || segments_.encroached_by(*place)) continue;
          // As near as it is to the node itself, others may be.
          if (!thinner_.has_room(*place, std::min(kSpacing * length, 0.99 * distance(*place, p)))) continue;
          thinner_.add(*place, kSpacing * length);
          points_.push_back(*place);
        }
      }
    }
  }

  /// The point of the surface nearest to p on either side.
  std::optional<Point3> on_surface(const Point3& p, const Vector3& step) const {
    std::optional<Point3> nearest;
    for (const Point3& q : oracle_.intersect_all(p - step, p + step)) {
      if (!nearest || squared_distance(p, q) < squared_distance(p, *nearest)) nearest = q;
    }
    return nearest;
  }

  const FeatureSegments& segments_;
  const Oracle& oracle_;
  const bool solid_;
  PoissonThinner& thinner_;
  std::vector<Point3> points_;
};

}  // namespace

std::vector<Point3> mirrored_points(const FeatureSegments& segments, const Oracle& oracle, bool solid,
                                    PoissonThinner& thinner, const GoOn& go_on) {
  return Rings(segments, oracle, solid, thinner).run(go_on);
}

}  // namespace delvox
