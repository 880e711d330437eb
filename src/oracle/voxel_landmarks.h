#pragma once

#include "delvox/oracle/oracle.h"
#include "oracle/brick_field.h"

namespace delvox {

/// A skeleton of both sides of a trilinear isosurface in the cells that it crosses, in grid coordinates: the grid
/// samples, the grid edges between samples of one side, and the saddles of faces and cells with the segments that join
/// them to samples of their side. Only points that are `wanted` and links between such; cells none of whose samples is
/// wanted, which several threads ask, are passed over. Empty if go_on says no, which is asked once a brick, for those of a
/// batch before it.
Landmarks voxel_landmarks(const BrickField& field, const std::function<bool(const Point3&)>& wanted, const GoOn& go_on);

}  // namespace delvox
