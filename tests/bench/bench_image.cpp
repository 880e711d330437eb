#include "bench_image.h"

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/volume/phantom.h"
#include "delvox/volume/preprocess.h"
#include "delvox/volume/read_volume.h"

namespace delvox::bench {

namespace {

constexpr const char kPhantomPrefix[] = "phantom:";

bool is_phantom(const std::string& path) {
  return path.starts_with(kPhantomPrefix);
}
std::string phantom_kind(const std::string& path) {
  return path.substr(sizeof(kPhantomPrefix) - 1);
}

Volume straightened(const Volume& volume) {
  VolumeHeader header = volume.header();
  const Vector3 spacing = header.spacing();
  header.index_to_world = Affine3{};
  for (int axis = 0; axis < 3; ++axis) header.index_to_world.rows[axis][axis] = spacing[axis];
  return Volume(header, volume.samples());
}

}  // namespace

double BenchImage::value(const Point3& u, Vector3* gradient) const {
  std::array<int, 3> cell{};
  std::array<double, 3> t{};
  for (int axis = 0; axis < 3; ++axis) {
    const double x = std::clamp(u[axis], 0.0, size[axis] - 1.0);
    cell[axis] = std::min(static_cast<int>(x), size[axis] - 2);
    t[axis] = x - cell[axis];
  }
  double sum = 0;
  Vector3 slope;
  for (int corner = 0; corner < 8; ++corner) {
    const int bit[3] = {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    const double g = sample(cell[0] + bit[0], cell[1] + bit[1], cell[2] + bit[2]) - level;
    double weight[3];
    for (int axis = 0; axis < 3; ++axis) weight[axis] = bit[axis] ? t[axis] : 1 - t[axis];
    sum += weight[0] * weight[1] * weight[2] * g;
    slope.x += (bit[0] ? g : -g) * weight[1] * weight[2];
    slope.y += (bit[1] ? g : -g) * weight[0] * weight[2];
    slope.z += (bit[2] ? g : -g) * weight[0] * weight[1];
  }
  if (gradient) *gradient = slope;
  return sum;
}

BenchImage make_bench_image(const Volume& volume, const Isosurface& surface) {
  const LevelSet level_set(surface);
  BenchImage image;
  image.spacing = volume.header().spacing();
  image.level = level_set.level;
  for (int axis = 0; axis < 3; ++axis) image.size[axis] = volume.dims()[axis] + 2;
  image.samples.resize(static_cast<std::size_t>(image.size[0]) * image.size[1] * image.size[2]);
  copy_padded_block(volume, level_set, {-1, -1, -1}, image.size, image.samples.data());
  return image;
}

double phantom_isovalue(const std::string& path) {
  if (!is_phantom(path)) throw OptionError("--iso is needed for a volume from a file");
  return phantom_truth(phantom_kind(path), phantom_defaults(phantom_kind(path))).isovalue;
}

Volume prepare_volume(const std::string& path, double smooth_mm) {
  Volume volume = is_phantom(path) ? make_phantom(phantom_kind(path)) : read_volume(path);
  if (smooth_mm > 0) volume = smooth(volume, {smooth_mm});
  return straightened(volume);
}

}  // namespace delvox::bench
