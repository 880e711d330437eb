#pragma once

#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Scattered places with a value each (book, 14.1.3).
struct Samples {
  std::vector<Point3> points;  ///< mm
  std::vector<double> values;  ///< one per point
  Frame frame = Frame::kUnknown;
};

}  // namespace delvox
