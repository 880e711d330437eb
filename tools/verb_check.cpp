#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "console.h"
#include "delvox/check/check_mesh.h"
#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "exit_codes.h"
#include "format.h"
#include "mesh_output.h"
#include "report_json.h"
#include "signals.h"
#include "validators.h"
#include "verdict.h"
#include "thread_limit.h"
#include "verbs.h"
#include "volume_input.h"

namespace delvox::tools {
namespace {

struct Options {
  std::vector<std::string> meshes;
  VolumeInputOptions volume;
  std::string surface;
  IsosurfaceOptions isosurface;
  Promises bounds;
  std::string border, frame, report;
  bool same_topology = false;
  std::optional<double> feature_angle_degrees;
  ConsoleOptions console;

  Options() { isosurface.iso.clear(); }
};

void add_bound(CLI::App& app, const std::string& flag, std::optional<double>& bound, const std::string& text,
               const std::string& unit) {
  app.add_option(flag, bound, text)->check(finite_number(Zero::kAllowed))->type_name(unit);
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("MESH", options.meshes, "Meshes: .vtu .vtk .stl .ply .off .obj .mesh .msh .inp .feb .bdf .unv")
      ->required();
  auto* volume = app.add_option("--volume", options.volume.path, "Compare with this volume, preprocessed as below");
  volume->type_name("VOLUME");
  auto* surface = app.add_option("--surface", options.surface, "Compare with this polygon surface");
  surface->excludes(volume)->type_name("SURFACE");
  app.add_option("--feature-angle", options.feature_angle_degrees,
                 "Sharp edges of --surface, those between two facets whose normals are more than this apart, must be "
                 "edges of the mesh; cells with a node on them are counted apart, and bounds on shapes do not hold there "
                 "(default: what the mesh carries)")
      ->check(angle_above_zero(180))
      ->needs(surface)
      ->type_name("DEG");
  add_isovalue_options(app, options.isosurface);
  app.get_option("--iso")->needs(volume)->default_str("what the mesh carries");
  app.add_flag("--same-topology", options.same_topology,
               "Components and Euler number must equal those of the volume's isosurface, or of the surface");
  add_bound(app, "--min-angle", options.bounds.min_angle_degrees, "Lower bound on the angles of triangles", "DEG");
  add_bound(app, "--radius-edge", options.bounds.radius_edge, "Upper bound on circumradius / shortest edge", "RATIO");
  add_bound(app, "--cell-size", options.bounds.cell_size, "Upper bound on the circumradii of tets, mm", "MM");
  add_bound(app, "--max-roughness", options.bounds.max_roughness_degrees,
            "Upper bound on the angle between neighbouring triangles", "DEG");
  add_bound(app, "--min-dihedral", options.bounds.min_dihedral_degrees, "Lower bound on dihedral angles of tets", "DEG");
  app.add_option("--border", options.border, "open: the surface may end at the image border (default: as the mesh says)")
      ->check(CLI::IsMember({"close", "open"}))
      ->type_name("HOW");
  app.add_option("--frame", options.frame, "Patient frame of meshes that state none: ras or lps (default: that of what they are "
                 "compared with)")
      ->check(CLI::IsMember({"ras", "lps"}))
      ->type_name("FRAME");
  add_reading_options(app, options.volume);
  add_preprocessing_options(app, options.volume);
  add_component_options(app, options.isosurface);
  app.add_option("--report", options.report, "Write the results to a JSON file")->type_name("FILE.json");
  add_config_option(app);
  add_console_options(app, options.console, JsonFlag::kOffered);
  app.footer("Bounds that no flag gives are those that the mesh file carries, if any. Topology and orientation are always "
             "checked.");
}

const MeshInfo& info_of(const Mesh& mesh) {
  return std::visit([](const auto& m) -> const MeshInfo& { return m.info; }, mesh);
}

Promises bounds_for(const MeshInfo& info, const Promises& given) {
  Promises bounds = info.promises;
  if (given.min_angle_degrees) bounds.min_angle_degrees = given.min_angle_degrees;
  if (given.radius_edge) bounds.radius_edge = given.radius_edge;
  if (given.cell_size) bounds.cell_size = given.cell_size;
  if (given.max_roughness_degrees) bounds.max_roughness_degrees = given.max_roughness_degrees;
  if (given.min_dihedral_degrees) bounds.min_dihedral_degrees = given.min_dihedral_degrees;
  return bounds;
}

// The isosurface that a mesh is held to, in the volume as meshed: preprocessed, small components taken out.
struct Reference {
  Isosurface surface;
  Volume volume;
};

Reference reference_for(const std::string& path, const MeshInfo& info, const Volume& volume, const Options& options) {
  Isosurface surface{info.isovalue.value_or(0), info.below || options.isosurface.below};
  if (!options.isosurface.iso.empty()) {
    const FrameChange frame(volume.header().frame, options.frame);
    const ChosenIsosurface chosen = choose_isosurface(*source_of(volume), options.isosurface, frame);
    check_isosurface(chosen, volume);
    surface = chosen.surface;
    surface.below = info.below || options.isosurface.below;
  } else if (!info.isovalue) {
    throw OptionError(path + ": carries no isovalue; give --iso");
  }
  const double size = info.promises.size.value_or(0);
  return {surface, filter_volume(volume, surface, options.isosurface, size).volume};
}

// Carries a mesh to the frame of what it is compared with; one that states no frame is in --frame, or else in that.
void to_frame(Frame of_other, Mesh& mesh, const Options& options) {
  Frame own = info_of(mesh).frame;
  if (own == Frame::kUnknown && !options.frame.empty()) own = options.frame == "ras" ? Frame::kRas : Frame::kLps;
  if (of_other != Frame::kUnknown) FrameChange(own, of_other == Frame::kRas ? "ras" : "lps").apply(mesh);
}

// What meshes are compared with: one of the two, or nothing.
struct Original {
  std::optional<Volume> volume;
  std::optional<SurfaceMesh> surface;
};

Original read_original(const Options& options, const Console& console) {
  Original original;
  if (!options.volume.path.empty()) {
    original.volume = load(*open_input(options.volume, options.frame).source);
    tell_warnings(original.volume->header(), options.volume, console);
  }
  if (!options.surface.empty()) original.surface = surface_of(read_mesh(options.surface).mesh);
  return original;
}

CheckReport check_file(const std::string& path, const Original& original, const Options& options,
                       const Console& console) {
  MeshFile file = read_mesh(path);
  throw_if_cancelled();
  console.note(path + ": " + file.format + ", " + describe_counts(file.mesh));
  CheckOptions check;
  check.bounds = bounds_for(info_of(file.mesh), options.bounds);
  if (!options.border.empty()) check.open_border = options.border == "open";
  check.coordinate_error = file.coordinate_error;
  check.feature_angle_degrees = options.feature_angle_degrees;
  check.require_same_topology = options.same_topology;
  std::optional<Reference> reference;
  if (original.surface) {
    to_frame(original.surface->info.frame, file.mesh, options);
    check.surface = &*original.surface;
  }
  if (const auto& volume = original.volume) {
    reference = reference_for(path, info_of(file.mesh), *volume, options);
    to_frame(volume->header().frame, file.mesh, options);
    check.volume = &reference->volume;
    check.isosurface = reference->surface;
  }
  return check_mesh(file.mesh, check);
}

}  // namespace

void run_check(const Verb& verb, const Arguments& arguments) {
  CLI::App app(std::string(verb.summary) + "\n", std::string("delvox ") + verb.name);
  Options options;
  add_options(app, options);
  const ThreadLimit threads(app);
  if (!parse_arguments(app, arguments)) return;

  if (options.same_topology && options.volume.path.empty() && options.surface.empty()) {
    throw OptionError("--same-topology: as what? Give --volume or --surface");
  }
  for (const std::string& mesh : options.meshes) check_output(options.report, mesh);
  const Console console(options.console);
  const Original original = read_original(options, console);
  Json json = run_header(verb, arguments);
  json["options"] = options_json(app);
  json["meshes"] = Json::array();
  std::string first_fault;
  for (const std::string& path : options.meshes) {
    throw_if_cancelled();
    const CheckReport report = check_file(path, original, options, console);
    console.result((options.meshes.size() > 1 ? path + "\n" : "") + to_text(report));
    Json result{{"mesh", path}};
    result.update(to_json(report));
    json["meshes"].push_back(std::move(result));
    if (first_fault.empty() && !report.all_hold()) first_fault = path + ": " + verdict(report);
  }
  if (!options.report.empty()) write_json(json, options.report);
  if (console.json()) console.machine_result(text_of(json));
  if (!first_fault.empty()) throw PromiseBroken(first_fault);
}

}  // namespace delvox::tools
