#pragma once

#include <algorithm>

#include "delvox/core/geometry.h"

namespace delvox::check {

/// Distances at samples of triangles: the largest, and their mean by area.
class SampledDistances {
 public:
  void add(double distance, double weight) {
    max_ = std::max(max_, distance);
    weighted_ += distance * weight;
    weights_ += weight;
  }
  void append(const SampledDistances& later) {
    max_ = std::max(max_, later.max_);
    weighted_ += later.weighted_;
    weights_ += later.weights_;
  }
  double max() const { return max_; }
  double mean() const { return weights_ > 0 ? weighted_ / weights_ : 0; }

 private:
  double max_ = 0, weighted_ = 0, weights_ = 0;
};

/// Calls visit(point) for the centroid of a triangle, and for three points half-way to its corners.
template <class Visit>
void for_each_sample(const Point3& a, const Point3& b, const Point3& c, const Visit& visit) {
  visit(1.0 / 3 * a + 1.0 / 3 * b + 1.0 / 3 * c);
  visit(2.0 / 3 * a + 1.0 / 6 * b + 1.0 / 6 * c);
  visit(1.0 / 6 * a + 2.0 / 3 * b + 1.0 / 6 * c);
  visit(1.0 / 6 * a + 1.0 / 6 * b + 2.0 / 3 * c);
}

}  // namespace delvox::check
