#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "delvox/oracle/oracle.h"

namespace delvox {

/// Random numbers that depend on the seed alone.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}
  /// In [0, 1).
  double uniform();

 private:
  std::uint64_t state_;
};

/// Three points of the surface near its point x such that their triangle is persistent in the restricted Delaunay
/// triangulation of any sample that refinement makes of them, if sizes are 1-Lipschitz (book, end of 14.1, and
/// proposition 14.3): they are picked at random from the surface within B(x, size / 7), until a part of the surface in
/// that ball meets the line through their circumcentre that is perpendicular to their triangle. A smaller ball does as
/// well, by the same proof, and is taken if the surface is too crooked or too small for that one. None if there is no
/// such triangle down to the smallest ball that rounding allows.
std::optional<std::array<Point3, 3>> find_persistent_triangle(const Oracle& oracle, const Point3& x, double size,
                                                              RandomStream& random);

}  // namespace delvox
