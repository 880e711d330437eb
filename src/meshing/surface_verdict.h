#pragma once

#include "delaunay/surface_balls.h"
#include "delvox/meshing/criteria.h"

namespace delvox {

/// kTooDeviant: beyond the deviation bound, but at the smallest ball radius.
enum class SurfaceVerdict { kGood, kSplit, kTooDeviant };

/// Size, Quality and deviation (book, 14.1 and 14.4): is the surface ball of triangle abc to be split?
SurfaceVerdict judge(const SurfaceCriteria& criteria, const Point3& a, const Point3& b, const Point3& c,
                     const SurfaceBall& ball);

}  // namespace delvox
