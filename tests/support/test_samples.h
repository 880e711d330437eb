#pragma once

#include <cmath>
#include <functional>

#include "delvox/core/samples.h"
#include "support/random.h"

// Scattered samples of functions, for tests.

namespace delvox::test {

using Function = std::function<double(const Point3&)>;

/// The corners of [-1, 1]^3 and points in it; their values stay 0.
inline Samples cube_of_places(int inner, std::uint64_t seed) {
  Samples samples;
  for (int i = 0; i < 8; ++i) samples.points.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  Random random(seed);
  const Box3 box{{-1, -1, -1}, {1, 1, 1}};
  for (int i = 0; i < inner; ++i) samples.points.push_back(random.in(box));
  samples.values.assign(samples.points.size(), 0);
  return samples;
}

/// The nodes of a regular lattice, n along each edge of [-1, 1]^3, moved by up to `jitter` of a step.
inline Samples lattice_of_places(int n, double jitter, std::uint64_t seed) {
  Samples samples;
  Random random(seed);
  const double step = 2.0 / (n - 1);
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Vector3 move{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        samples.points.push_back(Point3{i * step - 1, j * step - 1, k * step - 1} + (jitter * step) * move);
      }
    }
  }
  samples.values.assign(samples.points.size(), 0);
  return samples;
}

inline Samples with_values(Samples samples, const Function& f) {
  for (std::size_t i = 0; i < samples.points.size(); ++i) samples.values[i] = f(samples.points[i]);
  return samples;
}

/// Inside positive.
inline double ball(const Point3& p) {
  return 0.7 - norm(p);
}
inline double torus(const Point3& p) {
  return 0.25 - std::hypot(std::hypot(p.x, p.y) - 0.6, p.z);
}

}  // namespace delvox::test
