#include "delvox/volume/level_set.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace delvox {

LevelSet::LevelSet(const Isosurface& surface) : sign(surface.below ? -1.0f : 1.0f) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const double signed_value = sign * surface.isovalue;
  float smallest_inside = static_cast<float>(signed_value);
  if (smallest_inside < signed_value) smallest_inside = std::nextafter(smallest_inside, kInfinity);
  const float largest_outside = std::nextafter(smallest_inside, -kInfinity);
  level = 0.5 * (static_cast<double>(smallest_inside) + static_cast<double>(largest_outside));
}

float LevelSet::nearest(bool on_inside) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float just_inside = static_cast<float>(level);
  if (!inside(just_inside)) just_inside = std::nextafter(just_inside, kInfinity);
  return sign * (on_inside ? just_inside : std::nextafter(just_inside, -kInfinity));
}

void pad_row(const LevelSet& level_set, const float* samples, int n, bool in_padding, float* out) {
  for (int i = 0; i < n; ++i) out[i + 1] = level_set.sign * samples[i];
  const auto push_outside = [&](float& g) {
    if (level_set.inside(g)) g = static_cast<float>(2 * level_set.level - g);
  };
  if (in_padding) std::for_each(out + 1, out + n + 1, push_outside);
  out[0] = out[1];
  out[n + 1] = out[n];
  push_outside(out[0]);
  push_outside(out[n + 1]);
}

void copy_padded_block(const Volume& volume, const LevelSet& level_set, const std::array<int, 3>& begin,
                       const std::array<int, 3>& size, float* out) {
  const std::array<int, 3>& dims = volume.dims();
  std::array<int, 3> low, extent;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::clamp(begin[axis], 0, dims[axis] - 1);
    extent[axis] = std::clamp(begin[axis] + size[axis] - 1, 0, dims[axis] - 1) - low[axis] + 1;
  }
  if (extent == size) {  // all of it in the image, as most blocks are
    volume.copy_block(begin, size, out);
    const std::size_t count = static_cast<std::size_t>(size[0]) * size[1] * size[2];
    if (level_set.sign < 0) std::transform(out, out + count, out, std::negate<>());
    return;
  }
  std::vector<float> inner(static_cast<std::size_t>(extent[0]) * extent[1] * extent[2]);
  volume.copy_block(low, extent, inner.data());
  for (int k = 0; k < size[2]; ++k) {
    const int kk = std::clamp(begin[2] + k, 0, dims[2] - 1);
    for (int j = 0; j < size[1]; ++j) {
      const int jj = std::clamp(begin[1] + j, 0, dims[1] - 1);
      const float* row =
          inner.data() + (static_cast<std::size_t>(kk - low[2]) * extent[1] + (jj - low[1])) * extent[0];
      const bool row_in_padding = kk != begin[2] + k || jj != begin[1] + j;
      for (int i = 0; i < size[0]; ++i) {
        const int ii = std::clamp(begin[0] + i, 0, dims[0] - 1);
        float g = level_set.sign * row[ii - low[0]];
        const bool in_padding = row_in_padding || ii != begin[0] + i;
        if (in_padding && level_set.inside(g)) g = static_cast<float>(2 * level_set.level - g);
        *out++ = g;
      }
    }
  }
}

}  // namespace delvox
