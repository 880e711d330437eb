#pragma once

#include <vector>

#include "delvox/core/geometry.h"
#include "oracle/brick_field.h"

namespace delvox {

/// Points, in grid coordinates, on a skeleton of both sides of a trilinear isosurface, in the cells that it crosses: the
/// grid samples, the grid edges between samples of one side, and the saddles of faces and cells with the segments that
/// join them to samples of their side. If all lie on the right side of a mesh, its pieces, gaps, tunnels and necks are
/// those of the voxels.
std::vector<Point3> voxel_landmarks(const BrickField& field);

}  // namespace delvox
