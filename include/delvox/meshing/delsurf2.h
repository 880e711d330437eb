#pragma once

#include <limits>

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"
#include "delvox/oracle/smooth_function.h"

namespace delvox {

/// What delsurf2 is asked for.
struct DelSurf2Options {
  /// Bounds beyond the right topology: the algorithm takes no size, but meets one if it is given.
  SurfaceCriteria surface{.size = std::numeric_limits<double>::infinity(), .min_angle_degrees = 30};
  RunControl control;
};

/// DelSurf2 (book, 14.2) with the Quality step (14.4): a triangulation of the surface {h = 0} inside a box that is
/// homeomorphic to it, whatever the sizes of its features (theorem 14.7), component by component; the domain is where
/// h <= 0. As h is given with enclosures, critical points are found without fail: what cannot be decided within 1e-6 of
/// the box's diagonal is told in the report as an unmet "topology". So are limits, and the mesh is what there was.
/// Throws OptionError, with the place, if the surface may reach the border of the box, or may have a kink or a point
/// without a normal; NothingToMesh if there is certainly no surface; Cancelled.
SurfaceMesh delsurf2(const SmoothFunction& h, const Box3& box, const DelSurf2Options& options, RunReport& report);
/// The same where the domain lies in the world.
SurfaceMesh delsurf2(const SmoothDomain& domain, const DelSurf2Options& options, RunReport& report);

}  // namespace delvox
