#pragma once

#include <filesystem>
#include <string>

#include "delvox/core/mesh.h"

namespace delvox {

/// A mesh as a file holds it, and how exactly it holds it.
struct MeshFile {
  Mesh mesh;
  std::string format;             ///< "VTU", "STL", ...
  double coordinate_error = 0;    ///< largest relative rounding of a coordinate that the format implies (0: exact double)
};

/// Reads what write_mesh writes, ours or not: .vtu .vtk .stl .ply .off .obj .mesh .msh .inp. Polygons are triangulated,
/// equal STL corners merged. Throws InputError, one line: file, cause, mend.
MeshFile read_mesh(const std::filesystem::path& path);

}  // namespace delvox
