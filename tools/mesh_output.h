#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "delvox/core/mesh.h"
#include "delvox/mesh_io/write_deck.h"

namespace delvox::tools {

struct MeshOutputOptions {
  std::vector<std::string> paths;
  std::string unit;               ///< m, mm, or empty: that of the mesh
  int order = 0;                  ///< of tets: 1 or 2; 0: that of the mesh
  std::vector<std::string> sets;  ///< NAME=RULE
  std::string deck;               ///< path of a JSON file; empty: none
  std::string materials;          ///< path of a JSON file; empty: none
  std::string material;           ///< name of one of these, for the whole body; empty: none
};

/// -o OUT, repeatable, required.
void add_mesh_output_options(CLI::App& app, MeshOutputOptions& options);

/// --unit, --order, --set, --deck, --materials, --material: what goes for all outputs that hold tets.
void add_tet_output_options(CLI::App& app, MeshOutputOptions& options);
/// --unit m|mm.
void add_unit_option(CLI::App& app, std::string& unit);
/// Sets the unit that the mesh is written in, if one was asked for.
void apply_unit(const std::string& unit, Mesh& mesh);

/// Throws unless every output can be written: extension known, folder writable, no path twice, none the input itself.
void check_mesh_outputs(const std::vector<std::string>& paths, const std::filesystem::path& input);

/// Throws unless `path` can be written and is not the input itself. Empty paths pass.
void check_output(const std::string& path, const std::filesystem::path& input);

/// What is to be computed on a mesh, and what it is made of, as --deck, --materials and --material say.
struct Analysis {
  std::optional<StaticDeck> deck;
  std::optional<Material> material;  ///< of all regions that have none

  /// Throws OptionError unless every set that the deck names is among `names`. `where`: for the message.
  void check_sets(const std::vector<std::string>& names, const std::string& where) const;
  /// Gives the material to the regions of the mesh that have none.
  void apply_material(TetMesh& mesh) const;
};

/// Reads the files. Throws OptionError, InputError.
Analysis read_analysis(const MeshOutputOptions& options);

/// Writes the mesh to every path, with the deck where it can be (.inp), and says so.
void write_mesh_outputs(const Mesh& mesh, const std::vector<std::string>& paths, const Console& console,
                        const std::optional<StaticDeck>& deck = std::nullopt);

/// The surface itself, or the boundary of the tets.
SurfaceMesh surface_of(const Mesh& mesh);

/// "12,345 tets, 2,345 triangles, 6,789 points".
std::string describe_counts(const Mesh& mesh);

}  // namespace delvox::tools
