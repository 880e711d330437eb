#pragma once

#include <array>
#include <cstdint>

namespace delvox {

/// Topology of {f > level} in one cell, f trilinear in the values at its corners (bit 0 of a corner's number: x,
/// bit 1: y, bit 2: z). Derivation in voxel_topology.h.
struct CellTopology {
  int euler = 0;        ///< of the part inside: its components minus its tunnels
  int face_parts = 0;   ///< sum over the six faces of the components inside
  std::array<std::uint8_t, 8> group{};  ///< the smallest corner that this one is joined with, inside or outside

  /// 8 * the compactly supported Euler characteristic of the inside, with each corner, edge and face shared among
  /// the cells around it; zero for cells of one sign.
  int weight(unsigned mask) const;
};

/// The cell's topology from its values; signs must be strict: no value equals level.
/// Exact: interval arithmetic first, integers of any length where that cannot decide.
CellTopology cell_topology(const std::array<float, 8>& values, double level);

/// True if the signs alone (bit c set: corner c is inside) do not settle the topology.
bool is_ambiguous(unsigned mask);

/// 8 * compactly supported Euler characteristic for the masks that is_ambiguous says no to.
int weight_of_simple_cell(unsigned mask);

/// Volume of {f > level} in the unit cell: exact along x, 4 x 4 Gauss points across.
double inside_fraction(const std::array<float, 8>& values, double level);

}  // namespace delvox
