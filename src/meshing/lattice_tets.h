#pragma once

#include <array>
#include <cstdint>

namespace delvox {

/// The Delaunay tetrahedra of a body-centred cubic lattice: around each edge of a cube, and each between the centres of
/// two cubes, lie four. Sites are numbered along x, y, z, first the corners of all cubes, then their centres.
class LatticeTets {
 public:
  using Site = std::uint32_t;
  /// Of a tet: along an edge of a cube. Twelve for each corner: those along the edges that leave it toward x, y, z.
  using Place = std::uint32_t;
  static constexpr Place kPerCorner = 12;

  /// `counts`: of cubes along each axis, five at least.
  explicit LatticeTets(const std::array<std::int32_t, 3>& counts);

  /// In positive order. pre: not at the rim.
  std::array<Site, 4> sites(Place place) const {
    std::array<Site, 4> sites = steps_[place % kPerCorner];
    for (Site& site : sites) site += place / kPerCorner;
    return sites;
  }
  /// The tet beyond the face opposite a site.
  Place across(Place place, int face) const { return place + across_[place % kPerCorner][face]; }

 private:
  // Modulo 2^32: from a corner to its tets' sites, and from a tet to its neighbours.
  std::array<std::array<Site, 4>, kPerCorner> steps_;
  std::array<std::array<Place, 4>, kPerCorner> across_;
};

}  // namespace delvox
