#pragma once

#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"
#include "oracle/brick_field.h"

namespace delvox {

/// Points on the isosurface of a brick field, in grid coordinates, Poisson-like at the wanted spacing and jittered
/// off the grid lines by a hash of their place: crossings on plain grid lines are coplanar and cocircular,
/// which Delaunay predicates pay for. Every component of a trilinear isosurface crosses a grid edge, so each is found;
/// one smaller than the spacing gets a denser set of its own.
/// `grid_to_world` maps grid coordinates to world; `size` is the wanted spacing. When go_on says no, what there is by
/// then is returned.
Seeds voxel_seeds(const BrickField& field, const Affine3& grid_to_world, const SizeField& size, const GoOn& go_on);

}  // namespace delvox
