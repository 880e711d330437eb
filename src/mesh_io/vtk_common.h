#pragma once

#include <string>
#include <utility>
#include <vector>

#include "delvox/core/mesh.h"
#include "mesh_io/raw_mesh.h"

namespace delvox::mesh_io {

// What VTU and legacy VTK share.
inline constexpr int kVtkTriangle = 5, kVtkTet = 10, kVtkQuadraticTet = 24;
inline constexpr const char* kRegionArray = "region";
inline constexpr const char* kOnSurfaceArray = "on_surface";

/// Arrays of the sets of a VTU file, by name of the set: 1 for each node or tet in it; for faces one bit for each face
/// of each tet (kTetFaces), the lowest for face 0.
inline constexpr const char *kSetNodes = "set_nodes_", *kSetTets = "set_tets_", *kSetFaces = "set_faces_";

CellKind vtk_cell_kind(std::int64_t vtk_type);

/// MeshInfo as named numbers for VTK's field data. Numbers, not strings: meshio reads no string arrays.
std::vector<std::pair<std::string, double>> info_fields(const MeshInfo& info);
/// Takes one of those back; unknown names are passed over.
void read_info_field(const std::string& name, double value, MeshInfo& info);

}  // namespace delvox::mesh_io
