#include "meshing/topological_balls.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash.h"
#include "delaunay/spatial_order.h"
#include "meshing/umbrella.h"
#include "meshing/voronoi_faces.h"

namespace delvox {
namespace {

/// Random choices are made so often before a question counts as undecided.
constexpr int kAttempts = 4;
/// The cover is divided to boxes as wide as this share of their distance from the site, but to no more than so many:
/// then critical points are searched for.
constexpr double kBoxShare = 1.0 / 12;
constexpr std::size_t kMostBoxes = 512;

const Point3& farthest_from(const Point3& p, const std::vector<Point3>& points) {
  return *std::max_element(points.begin(), points.end(), [&](const Point3& a, const Point3& b) {
    return squared_distance(a, p) < squared_distance(b, p);
  });
}

Vector3 normalized(const Vector3& v) {
  return (1 / norm(v)) * v;
}

}  // namespace

TopologicalBalls::TopologicalBalls(RestrictedDelaunay& delaunay, SurfaceCover& cover, const CertifiedOracle& oracle)
    : delaunay_(delaunay), cover_(cover), oracle_(oracle), margin_(1e-9 * cover.box().diagonal()) {}

/// VorEdge(e): an edge that meets the surface more than once, or touches it, gives its crossing farthest from its
/// sites.
std::optional<Point3> TopologicalBalls::vor_edge(FacetId sigma) {
  const CellId neighbor = delaunay_.neighbors(sigma.cell)[sigma.index];
  const Point3& p = delaunay_.point(delaunay_.vertices(sigma)[0]);
  const FoundPoints crossings =
      find_crossings(cover_, delaunay_.sphere(sigma.cell).center, delaunay_.sphere(neighbor).center);
  if (crossings.points.size() > 1) return farthest_from(p, crossings.points);  // c_max
  if (crossings.undecided.empty()) return std::nullopt;
  return settle(farthest_from(p, crossings.undecided), p, "a Voronoi edge may touch the surface");
}

/// TopoDisk(p): where T_p is neither empty nor a topological disk, the centre of its largest surface ball.
/// pre: vor_edge is null everywhere, so that each restricted triangle has one.
std::optional<Point3> TopologicalBalls::topo_disk(VertexId p) {
  const Umbrella t_p = find_umbrella(delaunay_, p);  // step 1
  if (t_p.disk) return std::nullopt;                 // step 2
  SurfaceBall largest;                               // step 3
  for (FacetId sigma : t_p.facets) {
    const SurfaceBall* known = delaunay_.ball(sigma);
    const SurfaceBall& ball = known != nullptr ? *known : delaunay_.compute_ball(sigma);
    if (ball.squared_radius > largest.squared_radius) largest = ball;
  }
  return largest.center;
}

/// VorFacet(g): a facet that touches the surface, or meets it in a loop.
std::optional<Point3> TopologicalBalls::vor_facet(VertexId p, VertexId q) {
  const auto facet = voronoi_facet(delaunay_, p, q, cover_.box(), margin_);
  if (!facet) return std::nullopt;
  const PlanePart& g = *facet;
  const Point3& site = delaunay_.point(p);
  std::optional<Point3> undecided;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Vector3 d = facet_direction(g, p, q, attempt);  // step 2
    const Vector3 across = cross(g.normal(), d);
    const auto boxes = cover_.critical_boxes(g.region, across, site, kBoxShare, kMostBoxes);
    if (boxes.empty()) return std::nullopt;  // step 3
    const FoundPoints found = find_critical_points(cover_, g, across, boxes, ~std::size_t{0});
    for (const Point3& x : found.points) {  // step 4
      if (!contains(g.region, x)) continue;
      if (const auto y = farthest_crossing(g, x, d, site)) return y;
    }
    if (found.undecided.empty()) return std::nullopt;  // step 5
    undecided = farthest_from(site, found.undecided);  // step 1, or a direction to which a curve clings
  }
  return settle(*undecided, site, "a Voronoi facet may touch the surface");
}

/// Any direction in the facet's plane will do. The first is that of the curve in which facet and surface meet, if they
/// do: then the curve has no critical points as long as it turns by less than a right angle.
Vector3 TopologicalBalls::facet_direction(const PlanePart& g, VertexId p, VertexId q, int attempt) const {
  const Vector3 normal = g.normal();
  if (attempt == 0) {
    Vector3 sum;
    for (CellId cell : delaunay_.incident_cells(p)) {
      for (int i = 0; i < 4; ++i) {
        const FacetId sigma{cell, i};
        if (!delaunay_.bipolar(sigma)) continue;
        const auto v = delaunay_.vertices(sigma);
        if (std::find(v.begin(), v.end(), p) == v.end() || std::find(v.begin(), v.end(), q) == v.end()) continue;
        const SurfaceBall* ball = delaunay_.ball(sigma);
        const Point3 end = ball != nullptr ? ball->center : delaunay_.find_ball(sigma, oracle_).center;
        sum = sum + normalized(oracle_.gradient(end));
      }
    }
    const Vector3 d = cross(normal, sum);
    if (norm(d) > 0.1) return normalized(d);
  }
  const Vector3 random = random_direction(p, q, attempt);
  return normalized(cross(normal, random));
}

/// Step 4 (a), (b): Y, what the line through x parallel to d and the facet have in common with the surface; if that is
/// more than x, the point in it farthest from the site.
std::optional<Point3> TopologicalBalls::farthest_crossing(const PlanePart& g, const Point3& x, const Vector3& d,
                                                          const Point3& p) const {
  const auto line = clip_line(g.region, x, d, 2 * cover_.box().diagonal());
  if (!line) return std::nullopt;
  FoundPoints y = find_crossings(cover_, (*line)[0], (*line)[1]);
  y.points.insert(y.points.end(), y.undecided.begin(), y.undecided.end());
  if (y.points.size() < 2) return std::nullopt;
  return farthest_from(p, y.points);
}

/// Silhouette(p): where V_p meets the silhouette of the direction n_p, V_p and the surface may share more than a disk.
std::optional<Point3> TopologicalBalls::silhouette(VertexId p) {
  const ConvexRegion cell = voronoi_cell(delaunay_, p, margin_);
  const Point3& site = delaunay_.point(p);
  const Vector3 normal = normalized(oracle_.gradient(site));
  std::optional<Point3> undecided;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    constexpr double kTiny = 0.02;
    const Vector3 d = normalized(normal + kTiny * random_direction(p, p, 2 * attempt));     // step 1
    const Vector3 d_prime = normalized(cross(d, random_direction(p, p, 2 * attempt + 1)));  // step 2
    undecided.reset();
    if (const auto x = silhouette_point(p, cell, d, d_prime, undecided)) return x;
    if (!undecided) return std::nullopt;  // step 6
  }
  return settle(*undecided, site, "a silhouette may meet a Voronoi cell");
}

std::optional<Point3> TopologicalBalls::silhouette_point(VertexId p, const ConvexRegion& cell, const Vector3& d,
                                                         const Vector3& d_prime, std::optional<Point3>& undecided) {
  const Point3& site = delaunay_.point(p);
  const auto boxes = cover_.critical_boxes(cell, d, site, kBoxShare, kMostBoxes);
  if (boxes.empty()) return std::nullopt;  // no point of J_d
  const auto first_of = [&](const FoundPoints& found) -> std::optional<Point3> {
    if (!found.points.empty()) return found.points[0];
    if (!found.undecided.empty()) undecided = farthest_from(site, found.undecided);
    return std::nullopt;
  };
  // Steps 3 and 4: SilhouetteCritical(Sigma, d, d'), in V_p.
  if (const auto x = first_of(find_silhouette_critical_points(cover_, cell, d, d_prime, boxes, 1))) return x;
  for (VertexId q : voronoi_neighbors(delaunay_, p)) {  // step 5: SilhouettePlane(Sigma, aff g, d), on g
    const auto g = voronoi_facet(delaunay_, p, q, cover_.box(), margin_);
    if (!g) continue;
    std::vector<IntervalBox> near;
    std::copy_if(boxes.begin(), boxes.end(), std::back_inserter(near),
                 [&](const IntervalBox& box) { return !outside(g->region, box); });
    if (const auto y = first_of(find_critical_points(cover_, *g, d, near, 1))) return y;
  }
  return std::nullopt;
}

/// What to insert where a question stays open: the surface's point there, unless it is on the site.
std::optional<Point3> TopologicalBalls::settle(const Point3& undecided, const Point3& site, const char* what) {
  constexpr double kTooClose = 1e-4;  // of the box's diagonal
  const auto x = oracle_.project(undecided);
  if (x && distance(*x, site) > kTooClose * cover_.box().diagonal()) return x;
  if (!unmet_.empty() && unmet_.back().reason == what) {
    ++unmet_.back().count;
  } else {
    unmet_.push_back({"topology", 1, undecided, what, true});
  }
  return std::nullopt;
}

/// A hash of places, so that results do not depend on numbers.
Vector3 TopologicalBalls::random_direction(VertexId p, VertexId q, int attempt) const {
  const std::uint64_t seed = hash_point(delaunay_.point(p)) ^ mix_hash(hash_point(delaunay_.point(q)) + 2 * attempt);
  const double z = 2 * unit_interval(mix_hash(seed)) - 1;
  const double angle = 2 * std::numbers::pi * unit_interval(mix_hash(seed + 1)), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace delvox
