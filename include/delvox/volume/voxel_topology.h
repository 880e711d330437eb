#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/volume/level_set.h"

namespace delvox {

/// What the trilinear isosurface of a padded volume looks like.
struct VoxelTopology {
  std::size_t surface_components = 0;
  std::size_t inside_components = 0;
  std::size_t cavities = 0;  ///< outside components that do not reach the padding
  long euler = 0;            ///< of the surface: twice that of the inside
};

}  // namespace delvox
