#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/hash.h"
#include "delvox/core/geometry.h"

namespace delvox::test {

/// Numbers that look random and are the same everywhere, unlike those of <random>'s distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mix_hash(seed)) {}

  std::uint64_t bits() { return mix_hash(state_++); }
  double unit() { return unit_interval(bits()); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int n) { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }
  Point3 in(const Box3& box) {
    return {between(box.min.x, box.max.x), between(box.min.y, box.max.y), between(box.min.z, box.max.z)};
  }
  /// Uniform on the unit sphere (Archimedes).
  Vector3 direction() {
    const double z = between(-1, 1), angle = between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::uint64_t state_;
};

}  // namespace delvox::test
