#pragma once

#include <filesystem>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// Writes a mesh in the format that the extension names. Tets and surfaces: .vtu, .vtk, .mesh, .msh (4.1; `.msh2` is
/// 2.2), .inp, .feb, .bdf and .nas, .unv, .med, .xdmf (arrays in a .h5 beside it, sets of faces in _facets.xdmf and
/// _facets.h5). Surfaces only (a tet mesh gives its boundary): .stl, .ply, .off, .obj. Coordinates keep every bit but
/// in .stl (float32), .inp (12 digits: CalculiX misreads longer fields) and .bdf (16 characters). Each file names its
/// frame in a comment, as SPACE=RAS, SPACE=LPS (which Slicer obeys) or SPACE=unknown, and says INCOMPLETE if a limit
/// stopped the run; .vtu and .vtk carry all of MeshInfo, lengths in mm whatever the unit, .vtu the quality of each
/// cell. Coordinates are written in the unit that MeshInfo states. Tets of second order go to every format for tets;
/// sets to all of these but .vtk, .mesh and .msh2; materials to .inp, .feb and .bdf. The bytes depend on the mesh
/// alone, and in .xdmf on the file's name. pre: indices are valid, coordinates finite. Throws IoError, OptionError
/// (unknown extension).
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

/// The files that write_mesh may make for this path: itself, and with .xdmf those beside it.
/// Throws OptionError unless the extension is known.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& path);

}  // namespace delvox
