#pragma once

#include <array>

#include "delvox/volume/volume.h"

namespace delvox {

/// A copy of a volume in which runs of voxels are set.
class GridEditor {
 public:
  explicit GridEditor(const Volume& volume);
  ~GridEditor();
  /// Sets `length` voxels from `begin` on along i. Blocks that are stored as one value must be covered by runs of the
  /// same value in the end: they are set as a whole.
  void set_run(const std::array<int, 3>& begin, int length, float value);
  /// The result. pre: called once.
  Volume finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delvox
