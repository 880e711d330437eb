#pragma once

#include "delvox/oracle/oracle.h"
#include "oracle/brick_field.h"

namespace delvox {

/// A skeleton of both sides of a trilinear isosurface in the cells that it crosses, in grid coordinates: the grid
/// samples, the grid edges between samples of one side, and the saddles of faces and cells with the segments that join
/// them to samples of their side. Only points that are `wanted` and links between such; cells none of whose samples is
/// wanted are passed over. Several threads ask `wanted`; the caller's asks go_on, once for each brick, before the batch
/// that it belongs to. Empty if that says no.
Landmarks voxel_landmarks(const BrickField& field, const std::function<bool(const Point3&)>& wanted, const GoOn& go_on);

}  // namespace delvox
