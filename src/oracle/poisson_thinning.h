#pragma once

#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// A point and the distance that it keeps from others.
struct SpacedPoint {
  Point3 point;
  double spacing = 0;
};

/// Indices of a maximal subset, taken greedily in the order of `candidates`, in which every two points p, q are at
/// least min(spacing(p), spacing(q)) apart. pre: spacings positive.
std::vector<std::uint32_t> thin_poisson(const std::vector<SpacedPoint>& candidates);

}  // namespace delvox
