#pragma once

#include <optional>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "oracle/surface_zeros.h"

namespace delvox {

/// What of the Voronoi cell V_p lies in a box: a hair larger than it is, by `margin`.
ConvexRegion voronoi_cell(const RestrictedDelaunay& delaunay, VertexId p, double margin);

/// Sites whose Voronoi cells meet V_p in a facet, corners left out.
std::vector<VertexId> voronoi_neighbors(const RestrictedDelaunay& delaunay, VertexId p);

/// What lies in `box` of the Voronoi facet that the cells of p and q share, a hair larger than it is, by `margin`; none
/// if they share none there.
std::optional<PlanePart> voronoi_facet(const RestrictedDelaunay& delaunay, VertexId p, VertexId q, const Box3& box,
                                       double margin);

/// What lies in `region` of the line through `p` along the unit vector `direction`: its two ends; none if it misses it.
/// `reach`: how far from p to look at most.
std::optional<std::array<Point3, 2>> clip_line(const ConvexRegion& region, const Point3& p, const Vector3& direction,
                                               double reach);

}  // namespace delvox
