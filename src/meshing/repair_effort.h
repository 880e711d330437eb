#pragma once

#include <array>
#include <cstddef>

namespace delvox {

/// Counts topology repair's insertions by the radius of the balls that they split, octave by octave from a `widest`
/// radius down. The finer the necks and gaps of a domain, the rarer they are, and so are the insertions. Only along
/// rods and sheets of next to no thickness, as samples that equal the isovalue form them, does each halving of the
/// balls take a multiple of insertions: what is a few thousand at a tenth of a voxel is millions at the smallest ball,
/// and no manifold then. Once several octaves in a row have grown so, the last to a share of all vertices, repair is
/// hopeless.
class RepairEffort {
 public:
  /// 0: never hopeless.
  explicit RepairEffort(double widest) : widest_(widest) {}

  /// An insertion for a ball, into a mesh of so many vertices.
  void add(double radius, std::size_t vertices);
  bool hopeless() const { return hopeless_; }

 private:
  double widest_;
  std::array<std::size_t, 64> octaves_{};
  bool hopeless_ = false;
};

}  // namespace delvox
