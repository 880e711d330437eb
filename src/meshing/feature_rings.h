#pragma once

#include <vector>

#include "delvox/oracle/oracle.h"
#include "meshing/feature_segments.h"
#include "oracle/poisson_thinning.h"

namespace delvox {

/// Points for where facets meet at less than about 65 degrees, inside or outside, on one facet as on the other: the
/// corners of equilateral triangles in rows along the segments, until the facets are a segment's length apart. The
/// circumball of a triangle on one facet then holds no point of the other, and Voronoi vertices between the facets lie
/// midway: so that the triangles are restricted Delaunay, the segment an edge of one on each facet. Without that it
/// would take samples which happen to mirror each other. Likewise below lines that rise from a facet at a small angle,
/// as where three facets meet in a flat corner. Not in the book. Points keep clear of segments and of what `thinner`
/// holds, which they join. `solid`: tets between the facets are to have bounded radius-edge ratios, but for those with a
/// corner on the segment. Ends early once go_on() is false.
std::vector<Point3> mirrored_points(const FeatureSegments& segments, const Oracle& oracle, bool solid,
                                    PoissonThinner& thinner, const GoOn& go_on = always_go_on);

}  // namespace delvox
