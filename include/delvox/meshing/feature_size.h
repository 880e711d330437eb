#pragma once

#include <memory>
#include <vector>

#include "delvox/core/size_field.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// A 1-Lipschitz length as a function of place, mm: the least, over some points, of the length at a point and the
/// distance from it: what regularises size fields in the book (14.1, 14.4). Copies share what was computed.
class FeatureSize {
 public:
  /// pre: as many lengths as points, at least one; none is negative.
  FeatureSize(std::vector<Point3> points, std::vector<double> lengths);

  /// Thread-safe.
  double operator()(const Point3& p) const;

 private:
  class Tree;
  std::shared_ptr<const Tree> tree_;
};

/// Local feature size, the distance from the medial axis. The axis is approximated by the poles of points on the
/// surface about `spacing` apart: the farthest Voronoi vertices of their cells, inside and outside (Amenta and Bern,
/// "Surface reconstruction by Voronoi filtering", 1999). Of a smooth surface it comes the nearer the more spacings it
/// is; features of less than a few spacings cannot be told. Throws what go_on throws, NothingToMesh if there is no
/// surface.
FeatureSize local_feature_size(const Oracle& oracle, double spacing, const GoOn& go_on = always_go_on);

/// The least radius of curvature, as far as what is curved is near: an upper bound on the local feature size, which
/// also heeds parts of the surface that lie near but apart. Measured at points about `spacing` apart, by central
/// differences of the normal over half of that. Throws as local_feature_size().
FeatureSize curvature_radius(const SmoothOracle& oracle, double spacing, const GoOn& go_on = always_go_on);

/// A field as it is at points of the surface about `spacing` apart, made 1-Lipschitz, but nowhere greater than it is.
SizeField lipschitz(const SizeField& size, const Oracle& oracle, double spacing, const GoOn& go_on = always_go_on);

/// factor * feature, within [least, most]. pre: 0 < least <= most.
SizeField scaled(const FeatureSize& feature, double factor, double least, double most);

}  // namespace delvox
