#pragma once

#include <algorithm>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "delvox/volume/voxel_topology.h"
#include "support/shapes.h"

namespace delvox::test {

/// A phantom, and the size to mesh it at. At a size of up to half a voxel, the mesh has the topology of the voxels.
struct PhantomCase {
  std::string kind;
  PhantomOptions image;
  double size;
  std::optional<double> isovalue = std::nullopt;  ///< where not at the phantom's own

  Volume volume() const { return make_phantom(kind, image); }
  Isosurface isosurface() const { return {isovalue.value_or(phantom_truth(kind, image).isovalue), false}; }
  /// Where the topology of every voxel is asked for, necks of any width count.
  double min_ball_radius() const { return size <= 0.5 * voxel() ? 0 : 0.1 * voxel(); }
  double voxel() const { return std::min({image.spacing.x, image.spacing.y, image.spacing.z}); }
  friend void PrintTo(const PhantomCase& c, std::ostream* out) { *out << c.kind << " at size " << c.size; }
};

inline PhantomOptions with_noise(PhantomOptions options, double noise) {
  options.noise = noise;
  return options;
}

/// "noisy-sphere" as a test's name.
inline std::string test_name(const PhantomCase& c) {
  std::string name = c.kind;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace delvox::test
