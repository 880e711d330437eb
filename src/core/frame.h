#pragma once

#include <cmath>

#include "delvox/core/geometry.h"

namespace delvox {

/// Two unit vectors orthogonal to a unit vector and to each other: u x v is the vector.
inline void find_frame(const Vector3& unit, Vector3& u, Vector3& v) {
  int least = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(unit[axis]) < std::abs(unit[least])) least = axis;
  }
  Vector3 axis;
  axis[least] = 1;
  u = cross(axis, unit);
  u = (1 / norm(u)) * u;
  v = cross(unit, u);
}

}  // namespace delvox
