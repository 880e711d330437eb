#pragma once

#include "delvox/oracle/oracle.h"
#include "oracle/brick_field.h"

namespace delvox {

/// A skeleton of both sides of a trilinear isosurface in the cells that it crosses, in grid coordinates: the grid
/// samples, the grid edges between samples of one side, and the saddles of faces and cells with the segments that join
/// them to samples of their side.
Landmarks voxel_landmarks(const BrickField& field);

}  // namespace delvox
