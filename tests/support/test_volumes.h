#pragma once

#include <functional>
#include <vector>

#include "delvox/volume/volume.h"

namespace delvox::test {

/// A volume of the function's values at voxel indices; unit spacing unless an affine is given.
inline Volume volume_of(std::array<int, 3> dims, const std::function<double(double, double, double)>& f,
                        const Affine3& affine = {}) {
  std::vector<float> samples;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) samples.push_back(static_cast<float>(f(i, j, k)));
    }
  }
  VolumeHeader header;
  header.dims = dims;
  header.index_to_world = affine;
  return Volume(header, samples);
}

/// Signed distance to a sphere, positive inside.
inline double ball(double x, double y, double z, Point3 center, double radius) {
  return radius - distance({x, y, z}, center);
}

}  // namespace delvox::test
