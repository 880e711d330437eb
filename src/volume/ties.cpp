#include "delvox/volume/ties.h"

#include <algorithm>
#include <limits>

namespace delvox {

Ties::Ties(const Isosurface& surface)
    : surface_(surface), level_set_(surface), highest_outside_(-std::numeric_limits<float>::infinity()) {}

void Ties::add(const float* samples, std::size_t count) {
  // Two plain passes over what is in the cache: compilers turn each into a few vector instructions.
  const auto tied = static_cast<float>(surface_.isovalue);
  if (tied == surface_.isovalue) count_ += static_cast<std::size_t>(std::count(samples, samples + count, tied));
  float highest = highest_outside_;
  for (std::size_t i = 0; i < count; ++i) {
    const float g = level_set_.sign * samples[i];
    highest = !level_set_.inside(g) && g > highest ? g : highest;
  }
  highest_outside_ = highest;
}

double Ties::untied() const {
  if (highest_outside_ == -std::numeric_limits<float>::infinity()) return surface_.isovalue;
  // Not midway: saddles between integers often lie there, and then two sheets of the surface touch.
  constexpr double kTowardsIsovalue = 0.618;
  const double outside = level_set_.sign * highest_outside_;
  return outside + kTowardsIsovalue * (surface_.isovalue - outside);
}

}  // namespace delvox
