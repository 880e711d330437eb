#include "meshing/repair_effort.h"

#include <algorithm>
#include <cmath>

namespace delvox {

void RepairEffort::add(double radius, std::size_t vertices) {
  if (!(radius < widest_)) return;
  // Measured on scans at many isovalues: below a quarter of a voxel each octave takes a fraction of the one above.
  // Along rods it is twice as many, along sheets four times; octaves are not complete while they are counted. A few
  // rods in a large mesh do no harm but to themselves: they are followed down to the smallest ball.
  constexpr double kGrowth = 1.5;
  constexpr std::size_t kOctavesInARow = 3, kLeastCount = 100, kVerticesPerCount = 100;
  const auto last = static_cast<std::size_t>(std::min(std::log2(widest_ / radius), octaves_.size() - 1.0));
  ++octaves_[last];
  if (last < kOctavesInARow || octaves_[last] < std::max(kLeastCount, vertices / kVerticesPerCount)) return;
  bool grows = true;
  for (std::size_t i = last - kOctavesInARow; i < last; ++i) {
    grows &= octaves_[i] > 0 && static_cast<double>(octaves_[i + 1]) >= kGrowth * static_cast<double>(octaves_[i]);
  }
  hopeless_ |= grows;
}

}  // namespace delvox
