#include "meshing/voronoi_faces.h"

#include <algorithm>
#include <array>

#include "core/frame.h"

namespace delvox {
namespace {

using Point2 = std::array<double, 2>;

/// The points nearer to p than to q, and those up to a margin beyond.
HalfSpace nearer(const Point3& p, const Point3& q, double margin) {
  const Vector3 pq = q - p, normal = (1 / norm(pq)) * pq;
  return {normal, dot(normal, midpoint(p, q)) + margin};
}

/// Sutherland and Hodgman: what of a convex polygon satisfies a . x <= offset.
std::vector<Point2> clip(const std::vector<Point2>& polygon, const Point2& a, double offset) {
  const auto excess = [&](const Point2& x) { return a[0] * x[0] + a[1] * x[1] - offset; };
  std::vector<Point2> clipped;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double at_from = excess(from), at_to = excess(to);
    if (at_from <= 0) clipped.push_back(from);
    if ((at_from <= 0) == (at_to <= 0)) continue;
    const double t = at_from / (at_from - at_to);
    clipped.push_back({from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])});
  }
  return clipped;
}

/// The bounding rectangle of the part's region in its plane; false if there is nothing.
bool find_rectangle(PlanePart& part, double reach) {
  std::vector<Point2> polygon{{-reach, -reach}, {reach, -reach}, {reach, reach}, {-reach, reach}};
  for (const HalfSpace& half : part.region) {
    polygon = clip(polygon, {dot(half.normal, part.u), dot(half.normal, part.v)},
                   half.offset - dot(half.normal, part.origin));
    if (polygon.empty()) return false;
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto [least, most] = std::minmax_element(
        polygon.begin(), polygon.end(), [axis](const Point2& a, const Point2& b) { return a[axis] < b[axis]; });
    part.rectangle[axis] = {(*least)[axis], (*most)[axis]};
  }
  return true;
}

/// Other vertices of cells at p, each once, in a fixed order; only of cells that hold q too, unless that is kNone.
std::vector<VertexId> sites_around(const RestrictedDelaunay& delaunay, VertexId p, VertexId q) {
  std::vector<VertexId> sites;
  for (CellId cell : delaunay.incident_cells(p)) {
    const auto& v = delaunay.vertices(cell);
    if (q != kNone && std::find(v.begin(), v.end(), q) == v.end()) continue;
    for (VertexId site : v) {
      if (site != p && site != q && delaunay.kind(site) != VertexKind::kCorner) sites.push_back(site);
    }
  }
  std::sort(sites.begin(), sites.end());
  sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
  return sites;
}

bool share_a_cell(const RestrictedDelaunay& delaunay, VertexId p, VertexId q) {
  const auto& cells = delaunay.incident_cells(p);
  return std::any_of(cells.begin(), cells.end(), [&](CellId cell) {
    const auto& v = delaunay.vertices(cell);
    return std::find(v.begin(), v.end(), q) != v.end();
  });
}

}  // namespace

std::vector<VertexId> voronoi_neighbors(const RestrictedDelaunay& delaunay, VertexId p) {
  return sites_around(delaunay, p, kNone);
}

ConvexRegion voronoi_cell(const RestrictedDelaunay& delaunay, VertexId p, double margin) {
  ConvexRegion cell;
  for (VertexId q : voronoi_neighbors(delaunay, p)) {
    cell.push_back(nearer(delaunay.point(p), delaunay.point(q), margin));
  }
  return cell;
}

std::optional<PlanePart> voronoi_facet(const RestrictedDelaunay& delaunay, VertexId p, VertexId q, const Box3& box,
                                       double margin) {
  if (!share_a_cell(delaunay, p, q)) return std::nullopt;
  PlanePart facet;
  const Point3 &at_p = delaunay.point(p), &at_q = delaunay.point(q);
  const HalfSpace to_p = nearer(at_p, at_q, margin), to_q = nearer(at_q, at_p, margin);
  find_frame(to_p.normal, facet.u, facet.v);
  facet.origin = midpoint(at_p, at_q);
  for (VertexId site : sites_around(delaunay, p, q)) {
    facet.region.push_back(nearer(at_p, delaunay.point(site), margin));
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 normal;
    normal[axis] = 1;
    facet.region.push_back({normal, box.max[axis]});
    facet.region.push_back({-1.0 * normal, -box.min[axis]});
  }
  if (!find_rectangle(facet, 2 * box.diagonal())) return std::nullopt;
  facet.region.push_back(to_p);
  facet.region.push_back(to_q);
  return facet;
}

std::optional<std::array<Point3, 2>> clip_line(const ConvexRegion& region, const Point3& p, const Vector3& direction,
                                               double reach) {
  double low = -reach, high = reach;
  for (const HalfSpace& half : region) {
    const double slope = dot(half.normal, direction), excess = half.excess(p);
    if (slope > 0) high = std::min(high, -excess / slope);
    if (slope < 0) low = std::max(low, -excess / slope);
    if (slope == 0 && excess > 0) return std::nullopt;
  }
  if (low > high) return std::nullopt;
  return std::array{p + low * direction, p + high * direction};
}

}  // namespace delvox
