#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "console.h"
#include "delvox/check/check_mesh.h"
#include "delvox/core/errors.h"
#include "delvox/mesh_io/read_mesh.h"
#include "delvox/oracle/formula.h"
#include "delvox/oracle/spline_function.h"
#include "exit_codes.h"
#include "format.h"
#include "formula_flags.h"
#include "mesh_output.h"
#include "report_json.h"
#include "samples_input.h"
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
  std::string surface, samples, implicit, box;
  std::string interpolation = "trilinear";
  SamplesInputOptions samples_input;
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
  auto* samples = app.add_option("--samples", options.samples,
                                 "Compare with the isosurface of these scattered samples, linear between them");
  samples->excludes(volume)->excludes(surface)->type_name("SAMPLES");
  add_field_option(app, options.samples_input);
  app.get_option("--field")->needs(samples);
  add_formula_options(app, options.implicit, options.box, "Compare with a formula");
  app.get_option("--implicit")->excludes(volume)->excludes(surface)->excludes(samples);
  app.add_option("--interpolation", options.interpolation,
                 "What the volume's samples are taken for: trilinear, or the quintic B-spline that --algorithm delsurf2 "
                 "meshes, of up to 32 x 32 x 32 voxels")
      ->check(CLI::IsMember({"trilinear", "quintic"}))
      ->needs(volume)
      ->capture_default_str()
      ->type_name("HOW");
  app.add_option("--feature-angle", options.feature_angle_degrees,
                 "Sharp edges of --surface, those between two facets whose normals are more than this apart, must be "
                 "edges of the mesh; cells with a node on them are counted apart, and bounds on shapes do not hold there "
                 "(default: what the mesh carries)")
      ->check(angle_above_zero(180))
      ->needs(surface)
      ->type_name("DEG");
  add_isovalue_options(app, options.isosurface);
  app.get_option("--iso")->default_str("what the mesh carries");
  app.add_flag("--same-topology", options.same_topology,
               "Components and Euler number must equal those of what the meshes are compared with");
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
  for (const char* name : {"--spacing", "--volume-index", "--crop", "--resample", "--smooth", "--largest",
                           "--min-component", "--fill-cavities"}) {
    app.get_option(name)->needs(volume);
  }
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

// The isovalue that a mesh carries, unless --iso chooses another one: choose(frame).
template <class Choose>
Isosurface isosurface_of(const std::string& path, const MeshInfo& info, Frame frame, const Options& options,
                         const Choose& choose) {
  if (options.isosurface.iso.empty() && !info.isovalue) {
    const bool may_be_spline = !options.volume.path.empty() && options.interpolation != "quintic";
    throw OptionError(path + ": carries no isovalue; give --iso" +
                      (may_be_spline ? ", and --interpolation quintic if delsurf2 made it" : ""));
  }
  const bool below = info.below || options.isosurface.below;
  if (options.isosurface.iso.empty()) return {*info.isovalue, below};
  return {choose(FrameChange(frame, options.frame)).surface.isovalue, below};
}

// What a mesh is held to, in so far as it takes making.
struct Reference {
  std::optional<Volume> volume;  // as meshed: small components taken out
  std::optional<SurfaceMesh> polygons;  // the isosurface of samples
  std::shared_ptr<SmoothFunction> spline;
  std::optional<ImplicitFunction> function;
};

// The spline through the samples, whatever components its surface has.
void compare_with_spline(const Volume& volume, const Isosurface& surface, Reference& reference, CheckOptions& check) {
  SmoothDomain domain = make_spline_domain(volume, surface);
  reference.spline = std::move(domain.function);
  const auto evaluate = [spline = reference.spline](const Point3& p) {
    std::array<double, SmoothFunction::kResults[1]> results;
    spline->evaluate(p, 1, results.data());
    return results;
  };
  reference.function = ImplicitFunction{[evaluate](const Point3& p) { return evaluate(p)[0]; },
                                        [evaluate](const Point3& p) {
                                          const auto results = evaluate(p);
                                          return Vector3{results[1], results[2], results[3]};
                                        },
                                        domain.box};
  check.function = &*reference.function;
  check.function_to_world = domain.to_world;
}

void compare_with_volume(const std::string& path, const MeshInfo& info, const Volume& volume, const Options& options,
                         Reference& reference, CheckOptions& check) {
  const Isosurface surface = isosurface_of(path, info, volume.header().frame, options, [&](const FrameChange& frame) {
    const ChosenIsosurface chosen = choose_isosurface(*source_of(volume), options.isosurface, frame);
    check_isosurface(chosen, volume);
    return chosen;
  });
  if (options.interpolation == "quintic") return compare_with_spline(volume, surface, reference, check);
  reference.volume = filter_volume(volume, surface, options.isosurface, info.promises.size.value_or(0)).volume;
  check.volume = &*reference.volume;
  check.isosurface = surface;
}

void compare_with_formula(const std::string& path, const Mesh& mesh, const Options& options, Reference& reference,
                          CheckOptions& check) {
  const Formula formula(options.implicit);
  const Box3 box = parse_box(options.box);
  const auto& points = std::visit([](const auto& m) -> const std::vector<Point3>& { return m.points; }, mesh);
  if (!std::all_of(points.begin(), points.end(), [&](const Point3& p) { return !is_finite(p) || box.contains(p); })) {
    throw OptionError("--box '" + options.box + "': does not hold all of " + path + "; widen it");
  }
  reference.function = ImplicitFunction{[formula](const Point3& p) { return formula.value(p); },
                                        [formula](const Point3& p) { return formula.gradient(p); },
                                        box};
  check.function = &*reference.function;
}

// Carries a mesh to the frame of what it is compared with; one that states no frame is in --frame, or else in that.
void to_frame(Frame of_other, Mesh& mesh, const Options& options) {
  Frame own = info_of(mesh).frame;
  if (own == Frame::kUnknown && !options.frame.empty()) own = options.frame == "ras" ? Frame::kRas : Frame::kLps;
  if (of_other != Frame::kUnknown) FrameChange(own, of_other == Frame::kRas ? "ras" : "lps").apply(mesh);
}

// What meshes are compared with: one of the three, or nothing.
struct Original {
  std::optional<Volume> volume;
  std::optional<SurfaceMesh> surface;
  std::optional<SampleField> samples;
};

Original read_original(const Options& options, const Console& console) {
  Original original;
  if (!options.volume.path.empty()) {
    original.volume = load(*open_input(options.volume, options.frame).source);
    tell_warnings(original.volume->header(), options.volume, console);
  }
  if (!options.surface.empty()) original.surface = surface_of(read_mesh(options.surface).mesh);
  if (!options.samples.empty()) original.samples = read_samples_input(options.samples, options.samples_input).field;
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
  Reference reference;
  if (!options.implicit.empty()) compare_with_formula(path, file.mesh, options, reference, check);
  const SurfaceMesh* polygons = original.surface ? &*original.surface : nullptr;
  if (const auto& samples = original.samples) {
    const Frame frame = samples->samples().frame;
    reference.polygons = samples_isosurface(
        *samples, isosurface_of(path, info_of(file.mesh), frame, options,
                                [&](const FrameChange& to) { return choose_isosurface(*samples, options.isosurface, to); }));
    polygons = &*reference.polygons;
  }
  if (polygons != nullptr) {
    to_frame(polygons->info.frame, file.mesh, options);
    check.surface = polygons;
  }
  if (const auto& volume = original.volume) {
    compare_with_volume(path, info_of(file.mesh), *volume, options, reference, check);
    to_frame(volume->header().frame, file.mesh, options);
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

  const bool compares_isosurface = !options.volume.path.empty() || !options.samples.empty();
  if (options.same_topology && !compares_isosurface && options.surface.empty() && options.implicit.empty()) {
    throw OptionError("--same-topology: as what? Give --volume, --samples, --surface or --implicit");
  }
  if (!options.isosurface.iso.empty() && !compares_isosurface) {
    throw OptionError("--iso: of what? Give --volume or --samples");
  }
  if (options.same_topology && options.border == "open") {
    throw OptionError("--same-topology: is that of a closed surface; leave out --border open");
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
