#pragma once

#include "delaunay/surface_balls.h"
#include "delvox/meshing/criteria.h"

namespace delvox {

/// kTooDeviant: beyond the deviation bound, but at the smallest ball radius.
enum class SurfaceVerdict { kGood, kSplit, kTooDeviant };

/// Size, Quality and deviation (book, 14.1 and 14.4): is the surface ball of triangle abc to be split?
SurfaceVerdict judge(const SurfaceCriteria& criteria, const Point3& a, const Point3& b, const Point3& c,
                     const SurfaceBall& ball);

/// Is the sample dense where triangle abc is, as far as it alone can tell? With a ball of radius r, where the surface has
/// the radius of curvature R, the ball's centre is r^2 / 2R from the circumcentre, if r is small: their distance is at
/// most a share of r, which holds r below twice that share of R. Where the surface folds, or another part of it is
/// near, centres lie farther off. Theory has r below 0.09 of the local feature size (book, exercise 3), that is 0.045;
/// practice does with more, since what goes wrong is found (dense_refinement.cpp).
constexpr double kDenseOffset = 0.25;
bool dense_at(const Point3& a, const Point3& b, const Point3& c, const SurfaceBall& ball);

}  // namespace delvox
