#pragma once

#include "delvox/core/mesh.h"
#include "delvox/volume/volume.h"

namespace delvox::tools {

/// The part of a closed surface that lies within the voxel centres: triangles with a node in the padding around the
/// image are taken out (--border open), then those that would hang on the rest by a single point, then unused points.
SurfaceMesh open_at_border(const SurfaceMesh& surface, const VolumeHeader& header);

}  // namespace delvox::tools
