#include "mesh_output.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "core/output_file.h"
#include "deck_json.h"
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

bool is_inp(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".inp";
}

void add_material_options(CLI::App& app, MeshOutputOptions& options) {
  app.add_option("--deck", options.deck,
                 "Write .inp outputs as a linear static analysis that ccx and Abaqus run: supports, pressures, gravity "
                 "and displacements on sets, from a JSON file")
      ->type_name("FILE.json");
  auto* materials = app.add_option("--materials", options.materials,
                                   "Materials by name: {\"bone\": {\"youngs_modulus_mpa\": .., \"poisson_ratio\": .., "
                                   "\"density_kg_m3\": ..}, ...}");
  materials->type_name("FILE.json");
  app.add_option("--material", options.material, "Which of these the body is made of")
      ->needs(materials)
      ->type_name("NAME");
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
  add_material_options(app, options);
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

void Analysis::check_sets(const std::vector<std::string>& names, const std::string& where) const {
  if (!deck) return;
  for (const std::string& wanted : sets_of(*deck)) {
    if (std::find(names.begin(), names.end(), wanted) == names.end()) {
      throw OptionError(where + ": the deck names the set " + wanted + ", which there is not; name it by --set");
    }
  }
}

void Analysis::apply_material(TetMesh& mesh) const {
  if (!material) return;
  std::set<Label> regions(mesh.regions.begin(), mesh.regions.end());
  if (mesh.regions.empty()) regions.insert(1);
  for (const Material& known : mesh.materials) regions.erase(known.region);
  for (Label region : regions) {
    mesh.materials.push_back(*material);
    mesh.materials.back().region = region;
    if (regions.size() > 1) mesh.materials.back().name += "_" + std::to_string(region);
  }
}

Analysis read_analysis(const MeshOutputOptions& options) {
  std::map<std::string, Material> known;
  if (!options.materials.empty()) known = read_materials(options.materials);
  Analysis analysis;
  if (!options.material.empty()) {
    const auto found = known.find(options.material);
    if (found == known.end()) throw OptionError(options.materials + ": has no material " + options.material);
    analysis.material = found->second;
  }
  if (options.deck.empty()) return analysis;
  DeckFile file = read_deck(options.deck, known);
  analysis.deck = std::move(file.deck);
  if (!file.material.empty()) {
    if (analysis.material) throw OptionError(options.deck + ": states a material, and --material another");
    analysis.material = file.material[0];
  }
  const bool any_inp = std::any_of(options.paths.begin(), options.paths.end(), is_inp);
  if (!any_inp) throw OptionError("--deck is written to .inp files; give one as output");
  return analysis;
}

void write_mesh_outputs(const Mesh& mesh, const std::vector<std::string>& paths, const Console& console,
                        const std::optional<StaticDeck>& deck) {
  for (const std::string& path : paths) {
    throw_if_cancelled();
    if (deck && is_inp(path)) {
      write_deck(std::get<TetMesh>(mesh), *deck, path);
    } else {
      write_mesh(mesh, path);
    }
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
