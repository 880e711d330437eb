#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "delaunay/scratch.h"
#include "delaunay/star.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// The circumspheres of a star's tets: the same numbers as circumsphere() gives for each, from what they have in
/// common, two at a time.
class StarSpheres {
 public:
  /// Sets Star::Tet::sphere. `names`: of each tet, which of Star::corners its vertices other than the apex are;
  /// point_of(vertex): where it is.
  template <class PointOf>
  void find(Star& star, std::span<const std::array<std::uint32_t, 3>> names, const PointOf& point_of) {
    spokes_.clear();
    spokes_.make_room(star.corners.size());
    for (const Star::Corner& corner : star.corners) {
      const Point3& end = point_of(corner.vertex);
      const Vector3 spoke = end - star.apex;
      spokes_.push({spoke.x, spoke.y, spoke.z, squared_norm(spoke), &end});
    }
    find_all(star, names);
  }

 private:
  /// From the apex to a corner.
  struct Spoke {
    double x, y, z, squared;
    const Point3* end;
  };
  void find_all(Star& star, std::span<const std::array<std::uint32_t, 3>> names) const;

  Scratch<Spoke> spokes_;
};

}  // namespace delvox
