#pragma once

#include <filesystem>
#include <string>

#include "delvox/core/mesh.h"

namespace delvox {

/// A mesh as a file holds it, and how exactly it holds it.
struct MeshFile {
  Mesh mesh;
  std::string format;             ///< "VTU", "STL", "legacy VTK", "Gmsh MSH", "Abaqus INP", ...
  double coordinate_error = 0;    ///< relative rounding of a coordinate: 6e-8 for float32, 5e-12 for .inp, else 0
};

/// Reads what write_mesh writes, ours or not: .vtu .vtk .stl .ply .off .obj .mesh .msh .msh2 .inp .feb .bdf .nas .unv,
/// in text or binary; .med and .xdmf are written only. A file with tets gives a TetMesh (its triangles are passed over;
/// the boundary is boundary_of the tets), else a SurfaceMesh. Polygons are triangulated, equal STL corners merged
/// (triangles that collapse by that are dropped), mid nodes of cells other than ten-node tets dropped. Other volume
/// cells are an error, lines and points passed over. Orientation is left as it is. Files of ours that say "in m" are
/// brought to mm. Sets are read from .vtu and .bdf (ours), .inp (in capitals), .msh 4.1, .feb and .unv. regions are
/// those of the file: the array "region" in VTK, references, properties, physical groups or names of blocks elsewhere.
/// MeshInfo is whole in .vtu and .vtk; elsewhere comments give the frame, the unit and `complete`. Throws InputError,
/// one line: file, cause, mend. Nothing is allocated because a file only claims to be large.
MeshFile read_mesh(const std::filesystem::path& path);

/// Whether `path` has the extension of a mesh format, be it one that is only written.
bool is_mesh_path(const std::filesystem::path& path);

}  // namespace delvox
