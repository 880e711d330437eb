#include "mesh_output.h"

#include <CLI/CLI.hpp>

#include "core/output_file.h"
#include "delvox/core/errors.h"
#include "delvox/mesh_io/write_mesh.h"
#include "format.h"
#include "set_rules.h"
#include "signals.h"

namespace delvox::tools {
namespace {

namespace fs = std::filesystem;

// True if both names lead to one place; the file need not exist yet.
bool same_place(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

}  // namespace

void add_mesh_output_options(CLI::App& app, MeshOutputOptions& options) {
  app.add_option("-o,--output", options.paths,
                 "Mesh to write; the extension names the format: .vtu .vtk .mesh .msh (4.1; .msh2: 2.2) .inp .feb .bdf "
                 ".unv .med .xdmf, and for "
                 "surfaces .stl .ply .off .obj (of tets: their boundary). Repeat for several")
      ->required()
      ->allow_extra_args(false)
      ->type_name("OUT");
}

void add_unit_option(CLI::App& app, std::string& unit) {
  app.add_option("--unit", unit, "Unit of the coordinates written: mm or m (default: mm, or that of the mesh read)")
      ->check(CLI::IsMember({"m", "mm"}))
      ->type_name("UNIT");
}

void add_tet_output_options(CLI::App& app, MeshOutputOptions& options) {
  add_set_option(app, options.sets);
  add_unit_option(app, options.unit);
  app.add_option("--order", options.order, "Order of the tets: 1, or 2 for mid-side nodes (default: 1, or as read)")
      ->check(CLI::IsMember({1, 2}))
      ->type_name("N");
}

void apply_unit(const std::string& unit, Mesh& mesh) {
  if (unit.empty()) return;
  std::visit([&](auto& m) { m.info.unit = unit == "m" ? LengthUnit::kMetre : LengthUnit::kMillimetre; }, mesh);
}

void check_output(const std::string& path, const fs::path& input) {
  if (path.empty()) return;
  if (same_place(path, input)) throw OptionError(path + ": is the input as well; choose another name for the output");
  check_output_path(path);
}

void check_mesh_outputs(const std::vector<std::string>& paths, const fs::path& input) {
  std::vector<fs::path> files;
  for (const std::string& path : paths) {
    for (const fs::path& file : files_of(path)) {
      check_output(file.string(), input);
      for (const fs::path& other : files) {
        if (same_place(file, other)) throw OptionError(file.string() + ": would be written twice; choose other names");
      }
      files.push_back(file);
    }
  }
}

void write_mesh_outputs(const Mesh& mesh, const std::vector<std::string>& paths, const Console& console) {
  for (const std::string& path : paths) {
    throw_if_cancelled();
    write_mesh(mesh, path);
    console.note("wrote " + path);
  }
}

SurfaceMesh surface_of(const Mesh& mesh) {
  const auto* tets = std::get_if<TetMesh>(&mesh);
  return tets != nullptr ? boundary_surface(*tets) : std::get<SurfaceMesh>(mesh);
}

std::string describe_counts(const Mesh& mesh) {
  if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
    const std::string order = tets->mid_nodes.empty() ? "" : " of second order";
    return plural(tets->tets.size(), "tet") + order + ", " + plural(tets->boundary.size(), "boundary triangle") + ", " +
           plural(tets->points.size(), "point");
  }
  const auto& surface = std::get<SurfaceMesh>(mesh);
  return plural(surface.triangles.size(), "triangle") + ", " + plural(surface.points.size(), "point");
}

}  // namespace delvox::tools
