#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/run.h"
#include "oracle/certified_oracle.h"
#include "oracle/surface_zeros.h"

namespace delvox {

/// The subroutines that diagnose violations of the topological ball property (book, 14.2.1): each returns a point of
/// the surface to insert, or none. Those that have returned none for a Voronoi face need not be asked about it again:
/// insertions only shrink faces, and what has no crossing, loop or silhouette too many has none in its parts.
///
/// Critical points are found and counted by interval Newton searches (surface_zeros.h) in the part of the face that the
/// cover does not settle. What they cannot decide, as where a face touches the surface to rounding, is a violation:
/// a point there is inserted, so that the faces change. If it lies too close to a site for that, it is unmet, and told.
class TopologicalBalls {
 public:
  TopologicalBalls(RestrictedDelaunay& delaunay, SurfaceCover& cover, const CertifiedOracle& oracle);

  /// The edge is dual to a facet of Del S.
  std::optional<Point3> vor_edge(FacetId sigma);
  std::optional<Point3> topo_disk(VertexId p);
  /// The facet that the Voronoi cells of p and q share; if they share none (any more) there is nothing to say.
  std::optional<Point3> vor_facet(VertexId p, VertexId q);
  std::optional<Point3> silhouette(VertexId p);

  /// Where the property could be neither shown nor repaired.
  const std::vector<Unmet>& unmet() const { return unmet_; }

 private:
  std::optional<Point3> farthest_crossing(const PlanePart& g, const Point3& x, const Vector3& d, const Point3& p) const;
  Vector3 facet_direction(const PlanePart& g, VertexId p, VertexId q, int attempt) const;
  std::optional<Point3> silhouette_point(VertexId p, const ConvexRegion& cell, const Vector3& d, const Vector3& d_prime,
                                         std::optional<Point3>& undecided);
  std::optional<Point3> settle(const Point3& undecided, const Point3& site, const char* what);
  Vector3 random_direction(VertexId p, VertexId q, int attempt) const;

  RestrictedDelaunay& delaunay_;
  SurfaceCover& cover_;
  const CertifiedOracle& oracle_;
  double margin_;  ///< by which faces are taken for larger than they are: Voronoi vertices are rounded
  std::vector<Unmet> unmet_;
};

}  // namespace delvox
