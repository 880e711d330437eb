#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "console.h"
#include "delvox/core/mesh.h"

namespace delvox::tools {

struct MeshOutputOptions {
  std::vector<std::string> paths;
  std::string unit;               ///< m, mm, or empty: that of the mesh
  int order = 0;                  ///< of tets: 1 or 2; 0: that of the mesh
  std::vector<std::string> sets;  ///< NAME=RULE
};

/// -o OUT, repeatable, required.
void add_mesh_output_options(CLI::App& app, MeshOutputOptions& options);

/// --unit, --order, --set: what goes for all outputs that hold tets.
void add_tet_output_options(CLI::App& app, MeshOutputOptions& options);
/// --unit m|mm.
void add_unit_option(CLI::App& app, std::string& unit);
/// Sets the unit that the mesh is written in, if one was asked for.
void apply_unit(const std::string& unit, Mesh& mesh);

/// Throws unless every output can be written: extension known, folder writable, no path twice, none the input itself.
void check_mesh_outputs(const std::vector<std::string>& paths, const std::filesystem::path& input);

/// Throws unless `path` can be written and is not the input itself. Empty paths pass.
void check_output(const std::string& path, const std::filesystem::path& input);

/// Writes the mesh to every path, and says so.
void write_mesh_outputs(const Mesh& mesh, const std::vector<std::string>& paths, const Console& console);

/// The surface itself, or the boundary of the tets.
SurfaceMesh surface_of(const Mesh& mesh);

/// "12,345 tets, 2,345 triangles, 6,789 points".
std::string describe_counts(const Mesh& mesh);

}  // namespace delvox::tools
