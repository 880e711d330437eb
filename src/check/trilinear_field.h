#pragma once

#include <optional>
#include <vector>

#include "delvox/volume/level_set.h"

namespace delvox::check {

/// The trilinear function of a padded volume minus its level, positive inside, in voxel indices. Written apart from
/// the oracle: a dense copy of the samples and nothing clever.
class TrilinearField {
 public:
  TrilinearField(const Volume& volume, const Isosurface& surface);

  double value(const Point3& index) const;
  Vector3 gradient(const Point3& index) const;
  /// How far a point lies outside the padded image, in voxels; within it 0.
  double distance_outside(const Point3& index) const;

  /// Smallest t in [0, t_max] at which origin + t * direction crosses the isosurface: within a voxel the function is
  /// a cubic in t, so crossings in pairs are found as well.
  std::optional<double> first_crossing(const Point3& origin, const Vector3& direction, double t_max) const;

  /// Calls visit(index point) for every crossing of the isosurface with a grid edge whose number is a multiple of
  /// `stride`; returns how many crossings there are.
  template <class Visit>
  std::size_t for_each_grid_crossing(std::size_t stride, const Visit& visit) const;

 private:
  struct Cell {
    std::size_t base;
    Point3 local;
  };
  Cell locate(const Point3& index) const;
  std::optional<double> crossing_in_voxel(const Point3& origin, const Vector3& direction, double begin,
                                          double end) const;
  float sample(std::size_t i, std::size_t j, std::size_t k) const { return samples_[(k * n_[1] + j) * n_[0] + i]; }

  std::array<std::size_t, 3> n_;  // of the padded grid; its first sample has index -1
  double level_;
  std::vector<float> samples_;
};

template <class Visit>
std::size_t TrilinearField::for_each_grid_crossing(std::size_t stride, const Visit& visit) const {
  std::size_t count = 0;
  const std::size_t step[3] = {1, n_[0], n_[0] * n_[1]};
  std::size_t at = 0;
  for (std::size_t k = 0; k < n_[2]; ++k) {
    for (std::size_t j = 0; j < n_[1]; ++j) {
      for (std::size_t i = 0; i < n_[0]; ++i, ++at) {
        const std::size_t place[3] = {i, j, k};
        const bool inside = samples_[at] > level_;
        for (int axis = 0; axis < 3; ++axis) {
          if (place[axis] + 1 == n_[axis] || (samples_[at + step[axis]] > level_) == inside) continue;
          if (count++ % stride != 0) continue;
          Point3 p{static_cast<double>(i) - 1, static_cast<double>(j) - 1, static_cast<double>(k) - 1};
          const double here = samples_[at], there = samples_[at + step[axis]];
          p[axis] += (level_ - here) / (there - here);
          visit(p);
        }
      }
    }
  }
  return count;
}

}  // namespace delvox::check
