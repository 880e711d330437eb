#pragma once

#include <span>
#include <vector>

#include "check/element_quality.h"

namespace delvox::check {

/// Circumradii that grow with depth. The depth of a tet's circumcentre is taken as its distance from the nearest
/// boundary node, which is never below that from the surface, plus half of `size`: as well as a mesher knows it.
struct GradedBound {
  double size = 0;   ///< at the surface, mm
  double grade = 0;  ///< what is added per mm of depth
};

/// Circumradius / bound of the tets whose circumradius exceeds the size; the largest ratio, and how many exceed 1.
Extreme measure_gradation(const std::vector<Point3>& points, std::span<const Tet> tets,
                          std::span<const Triangle> boundary, const GradedBound& bound, Precision precision);

}  // namespace delvox::check
