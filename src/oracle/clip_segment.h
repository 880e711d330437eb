#pragma once

#include "delvox/core/geometry.h"

namespace delvox {

/// Cuts ab to a box; false if nothing is left. An end beyond the box is reckoned from the other, so that one far away
/// costs no digits.
bool clip_segment(const Box3& box, Point3& a, Point3& b);

}  // namespace delvox
