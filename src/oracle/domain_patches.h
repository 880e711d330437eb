#pragma once

#include <functional>

#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"
#include "oracle/brick_field.h"

namespace delvox {

/// Calls visit for boxes of 4x4x4 voxels of each mixed brick that hold anything, and for each brick that is inside as a
/// whole. Volumes count samples, areas count crossed grid edges: both are exact on the average over all places of a
/// surface against the grid. `grid_to_world` maps grid coordinates to world.
void visit_patches(const BrickField& field, const Affine3& grid_to_world,
                   const std::function<void(const DomainPatch&)>& visit);

}  // namespace delvox
