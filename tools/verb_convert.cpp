#include <CLI/CLI.hpp>

#include "console.h"
#include "delvox/mesh_io/read_mesh.h"
#include "format.h"
#include "mesh_output.h"
#include "thread_limit.h"
#include "verbs.h"

namespace delvox::tools {

void run_convert(const Verb& verb, const Arguments& arguments) {
  CLI::App app(std::string(verb.summary) + "\n", std::string("delvox ") + verb.name);
  std::string path;
  MeshOutputOptions output;
  ConsoleOptions console_options;
  app.add_option("MESH", path, "Mesh to read: .vtu .vtk .stl .ply .off .obj .mesh .msh .inp")->required();
  add_mesh_output_options(app, output);
  const ThreadLimit threads(app);
  add_console_options(app, console_options, JsonFlag::kAbsent);
  if (!parse_arguments(app, arguments)) return;

  check_mesh_outputs(output.paths, path);
  const Console console(console_options);
  const MeshFile file = read_mesh(path);
  console.note(path + ": " + file.format + ", " + describe_counts(file.mesh));
  write_mesh_outputs(file.mesh, output.paths, console);
}

}  // namespace delvox::tools
