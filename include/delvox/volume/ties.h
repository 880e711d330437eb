#pragma once

#include <cstddef>

#include "delvox/volume/level_set.h"

namespace delvox {

/// Samples that equal an isovalue. Where neighbours do, and what is around them lies outside, the isosurface is a rod or
/// sheet as thin as LevelSet's half float step: no triangle with bounded angles fits on it.
class Ties {
 public:
  explicit Ties(const Isosurface& surface);

  void add(const float* samples, std::size_t count);
  std::size_t count() const { return count_; }
  /// An isovalue that labels every sample alike and equals none; the isovalue itself if no sample is outside.
  double untied() const;

 private:
  Isosurface surface_;
  LevelSet level_set_;
  std::size_t count_ = 0;
  float highest_outside_;  // signed sample
};

}  // namespace delvox
