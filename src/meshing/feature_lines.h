#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// Sharp edges one after the other that are straight together.
struct FeatureLine {
  std::vector<Point3> points;        ///< from end to end, at least two
  std::vector<double> at;            ///< of each point: how far along the line it lies, from 0, mm
  std::vector<std::uint32_t> edges;  ///< of FeatureEdges, between each point and the next
  std::array<std::uint32_t, 2> ends{};  ///< of FeatureEdges::points: the first point and the last

  double length() const { return at.back(); }
  /// At so many mm from the first point.
  Point3 point(double along) const;
  /// That of `edges` which lies there.
  std::uint32_t edge(double along) const;
};

/// All sharp edges, cut where they turn, branch or end. What a line turns away from the straight between its ends is
/// within `tolerance`, mm.
std::vector<FeatureLine> feature_lines(const FeatureEdges& features, double tolerance);

}  // namespace delvox
