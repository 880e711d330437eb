#pragma once

#include <memory>

#include "delvox/oracle/oracle.h"
#include "delvox/volume/level_set.h"

namespace delvox {

/// The isosurface of a volume under trilinear interpolation of its samples, padded at the image border (level_set.h).
/// Crossings are on the surface to 1e-9 voxel or better; its topology is that of voxel_topology.h. Shares the volume's
/// samples. Throws NothingToMesh if no sample is inside; an image that is inside everywhere is closed by the padding.
std::unique_ptr<SmoothOracle> make_isosurface_oracle(const Volume& volume, const Isosurface& surface);

}  // namespace delvox
