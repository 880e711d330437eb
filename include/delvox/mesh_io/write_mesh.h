#pragma once

#include <filesystem>

#include "delvox/core/mesh.h"

namespace delvox {

/// Writes a mesh in the format that the extension names. Tets and surfaces: .vtu, .vtk, .mesh, .msh (4.1; `.msh2` is
/// 2.2), .inp. Surfaces only (a tet mesh gives its boundary): .stl, .ply, .off, .obj. The bytes depend on the mesh
/// alone. Throws IoError, OptionError (unknown extension).
void write_mesh(const Mesh& mesh, const std::filesystem::path& path);

/// Throws OptionError unless write_mesh knows the extension of `path`.
void check_mesh_extension(const std::filesystem::path& path);

}  // namespace delvox
