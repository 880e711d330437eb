#include "delaunay/star_spheres.h"

#include "core/pair_geometry.h"
#include "delaunay/circumsphere.h"

namespace delvox {
/// Step by step as circumsphere() does it, so that rounding is the same. There is an even number of tets: their outer
/// triangles form a closed surface.
void StarSpheres::find_all(Star& star, std::span<const std::array<std::uint32_t, 3>> names) const {
  const Point3 apex = star.apex;
  for (std::size_t first = 0; first < star.tets.size(); first += 2) {
    const std::array<std::size_t, 2> tets{first, first + 1};
    std::array<PairVector, 3> spoke;
    std::array<Pair, 3> squared;
    for (int i = 0; i < 3; ++i) {
      const Spoke &a = spokes_[names[tets[0]][i]], &b = spokes_[names[tets[1]][i]];
      spoke[i] = {Pair{a.x, b.x}, Pair{a.y, b.y}, Pair{a.z, b.z}};
      squared[i] = Pair{a.squared, b.squared};
    }
    const auto& [u, v, w] = spoke;
    const PairVector vw = cross(v, w);
    const Pair six_volume = dot(u, vw);
    const Pair safe = six_volume * six_volume - kSafeRatio * squared[0] * squared[1] * squared[2];
    const PairVector offset =
        (0.5 / six_volume) * (squared[0] * vw + squared[1] * cross(w, u) + squared[2] * cross(u, v));
    const Pair squared_radius = dot(offset, offset);
    for (int i = 0; i < 2; ++i) {
      Circumsphere& sphere = star.tets[tets[i]].sphere;
      sphere = {apex + Vector3{offset.x[i], offset.y[i], offset.z[i]}, squared_radius[i]};
      if (safe[i] >= 0) continue;
      const auto end = [&](int k) -> const Point3& { return *spokes_[names[tets[i]][k]].end; };
      sphere = circumsphere(apex, end(0), end(1), end(2));
    }
  }
}

}  // namespace delvox
