#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "delvox/volume/level_set.h"
#include "delvox/volume/volume.h"

namespace delvox::bench {

/// The image that all contenders mesh, in the form that CGAL's Image_3 wants: signed samples with the padding layer
/// that delvox meshes too (level_set.h), i fastest; inside is sample > level. Axis-aligned: sample (1, 1, 1), the first
/// voxel of the image, is at the origin.
struct BenchImage {
  std::array<int, 3> size{};  ///< padding included
  Vector3 spacing;            ///< mm
  double level = 0;
  std::vector<float> samples;

  float sample(int i, int j, int k) const { return samples[(static_cast<std::size_t>(k) * size[1] + j) * size[0] + i]; }
  /// Position in units of samples of a point in mm.
  Point3 to_grid(const Point3& p) const { return {p.x / spacing.x + 1, p.y / spacing.y + 1, p.z / spacing.z + 1}; }
  /// Trilinear value minus level at grid position u, clamped to the image, and its gradient per sample. Written for
  /// clarity, shared with no contender.
  double value(const Point3& u, Vector3* gradient = nullptr) const;
};

BenchImage make_bench_image(const Volume& volume, const Isosurface& surface);

/// Reads a volume file, or makes "phantom:KIND", smooths it, and drops origin and obliqueness, which CGAL's image
/// domain cannot hold.
Volume prepare_volume(const std::string& path, double smooth_mm);

/// The isovalue that goes with "phantom:KIND". Throws OptionError for anything else.
double phantom_isovalue(const std::string& path);

}  // namespace delvox::bench
