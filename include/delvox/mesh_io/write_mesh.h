#pragma once

#include <filesystem>

#include "delvox/core/mesh.h"

namespace delvox {

/// Writes a mesh in the format that the extension names. Tets and surfaces: .vtu, .vtk, .mesh, .msh (4.1; `.msh2` is
/// 2.2), .inp. Surfaces only (a tet mesh gives its boundary): .stl, .ply, .off, .obj. Coordinates keep every bit but in
/// .stl (float32) and .inp (12 digits: CalculiX misreads longer fields). Each file names its frame in a comment, as
/// SPACE=RAS, SPACE=LPS (which Slicer obeys) or SPACE=unknown, and says INCOMPLETE if a limit stopped the run; .vtu and
/// .vtk carry all of MeshInfo, lengths in mm whatever the unit, .vtu the quality of each cell. Coordinates are written
/// in the unit that MeshInfo states. Tets of second order go to every format for tets; sets to .vtu, .inp and (faces
/// and tets) .msh; materials to .inp. The bytes depend on the mesh alone.
/// pre: indices are valid, coordinates finite. Throws IoError, OptionError (unknown extension).
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

/// Throws OptionError unless write_mesh knows the extension of `path`.
void check_mesh_extension(const std::filesystem::path& path);

}  // namespace delvox
