#pragma once

#include <array>
#include <cstdint>

namespace delvox::mesh_io {

/// Which of our nodes stands at each place of a cell in a file. Ours: corners, then the mid-side nodes of kTetEdges (of
/// a triangle: 01, 12, 20).
struct NodeOrder {
  std::array<std::uint8_t, 4> tet4;
  std::array<std::uint8_t, 10> tet10;
  std::array<std::uint8_t, 6> triangle6;
};

/// VTK, XDMF, Abaqus, CalculiX, Nastran, FEBio, MEDIT.
inline constexpr NodeOrder kOwnOrder{{0, 1, 2, 3}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 1, 2, 3, 4, 5}};
/// Gmsh: 23 before 13.
inline constexpr NodeOrder kGmshOrder{{0, 1, 2, 3}, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}, {0, 1, 2, 3, 4, 5}};
/// I-DEAS universal: round the base, then up to the apex.
inline constexpr NodeOrder kUnvOrder{{0, 1, 2, 3}, {0, 4, 1, 5, 2, 6, 7, 8, 9, 3}, {0, 3, 1, 4, 2, 5}};
/// MED: tets are of the other orientation.
inline constexpr NodeOrder kMedOrder{{0, 2, 1, 3}, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}, {0, 1, 2, 3, 4, 5}};

/// Faces of a tet of Abaqus and CalculiX, S1 to S4, by the number of ours (kTetFaces): 123, 142, 243, 341.
inline constexpr std::uint8_t kAbaqusFace[4] = {3, 4, 2, 1};

}  // namespace delvox::mesh_io
