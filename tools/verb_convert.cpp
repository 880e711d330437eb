#include <CLI/CLI.hpp>

#include "console.h"
#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/meshing/second_order.h"
#include "exit_codes.h"
#include "format.h"
#include "mesh_output.h"
#include "set_rules.h"
#include "thread_limit.h"
#include "verbs.h"

namespace delvox::tools {

void run_convert(const Verb& verb, const Arguments& arguments) {
  CLI::App app(std::string(verb.summary) + "\n", std::string("delvox ") + verb.name);
  std::string path;
  MeshOutputOptions output;
  ConsoleOptions console_options;
  app.add_option("MESH", path, "Mesh to read: .vtu .vtk .stl .ply .off .obj .mesh .msh .inp .feb .bdf .unv")
      ->required();
  add_mesh_output_options(app, output);
  add_tet_output_options(app, output);
  const ThreadLimit threads(app);
  add_console_options(app, console_options, JsonFlag::kAbsent);
  if (!parse_arguments(app, arguments)) return;

  check_mesh_outputs(output.paths, path);
  const std::vector<NamedRule> rules = parse_sets(output.sets, nullptr);
  Analysis analysis = read_analysis(output);
  const Console console(console_options);
  MeshFile file = read_mesh(path);
  console.note(path + ": " + file.format + ", " + describe_counts(file.mesh));
  apply_unit(output.unit, file.mesh);
  std::string fault;
  if (auto* tets = std::get_if<TetMesh>(&file.mesh)) {
    if (output.order == 1 && !tets->mid_nodes.empty()) make_first_order(*tets);
    if (output.order == 2 && tets->mid_nodes.empty()) make_second_order(*tets, nullptr);
    fault = apply_sets(*tets, rules);
    std::vector<std::string> names;
    for (const MeshSet& set : tets->sets) names.push_back(set.name);
    analysis.check_sets(names, path);
    analysis.apply_material(*tets);
    if (!fault.empty() && analysis.deck) {
      fault += "; the deck is left out";
      analysis.deck.reset();
    }
  } else if (!rules.empty() || output.order != 0 || analysis.deck || analysis.material) {
    throw OptionError(path + ": holds no tets; --set, --order, --deck and --material are for tets");
  }
  write_mesh_outputs(file.mesh, output.paths, console, analysis.deck);
  if (!fault.empty()) throw PromiseBroken(output.paths.front() + ": written, but " + fault);
}

}  // namespace delvox::tools
