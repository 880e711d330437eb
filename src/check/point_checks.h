#pragma once

#include <vector>

#include "check/surface_topology.h"

namespace delvox::check {

/// Points that coincide with an earlier one within `distance` in every coordinate (0: exactly). pre: finite.
Tally duplicate_points(const std::vector<Point3>& points, double distance);

}  // namespace delvox::check
