#include "meshing/lattice_tets.h"

namespace delvox {

/// A tet along an edge has two neighbouring centres of the ring of four around the edge's middle.
LatticeTets::LatticeTets(const std::array<std::int32_t, 3>& counts) {
  const std::array<Site, 3> stride{1, static_cast<Site>(counts[0]), static_cast<Site>(counts[0] * counts[1])};
  const Site centre = stride[2] * static_cast<Site>(counts[2]);
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    const Site u = stride[second], v = stride[third];
    const Site low = centre - u - v;
    const std::array<Site, 4> ring{low, low + u, low + u + v, low + v};
    // Beyond the faces with but one end of the edge lie tets along edges that leave it along the axis in which both
    // centres are on the same side; they have the same centres, to one side of their edge.
    const std::array<std::array<int, 2>, 4> fixed{{{third, -1}, {second, 1}, {third, 1}, {second, -1}}};
    for (int i = 0; i < 4; ++i) {
      const int tet = 4 * axis + i;
      steps_[tet] = {0, stride[axis], ring[i], ring[(i + 1) % 4]};
      const auto [along, side] = fixed[i];
      const Site start = side > 0 ? 0 : 0 - stride[along];
      // Of the ring around an edge along `along`: the two centres that lie to that side of it in `axis`.
      const auto beyond = [&](bool positive) {
        const int in_ring = axis == (along + 1) % 3 ? (positive ? 1 : 3) : (positive ? 2 : 0);
        return static_cast<Place>(4 * along + in_ring);
      };
      const auto from_here = [&](Site corner, Place number) {
        return corner * kPerCorner + number - static_cast<Place>(tet);
      };
      across_[tet] = {from_here(start + stride[axis], beyond(false)), from_here(start, beyond(true)),
                      from_here(0, static_cast<Place>(4 * axis + (i + 1) % 4)),
                      from_here(0, static_cast<Place>(4 * axis + (i + 3) % 4))};
    }
  }
}

}  // namespace delvox
