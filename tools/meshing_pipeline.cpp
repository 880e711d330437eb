#include "meshing_pipeline.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "delvox/check/check_mesh.h"
#include "delvox/core/errors.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/delsurf2.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/meshing/graded_size.h"
#include "delvox/meshing/remove_slivers.h"
#include "delvox/meshing/second_order.h"
#include "exit_codes.h"
#include "forecast.h"
#include "format.h"
#include "meshing_domain.h"
#include "meshing_sizes.h"
#include "progress.h"
#include "report_json.h"
#include "run_effort.h"
#include "set_rules.h"
#include "signals.h"
#include "size_search.h"
#include "stopwatch.h"
#include "thread_limit.h"
#include "verdict.h"

namespace delvox::tools {
namespace {

std::unique_ptr<MeshingDomain> make_domain(const MeshingOptions& options) {
  if (!options.implicit.empty()) return make_formula_domain(options);
  if (options.volume.path.empty()) {
    throw OptionError("what to mesh? Give a VOLUME or samples, or --implicit and --box; see --help");
  }
  if (options.input == InputKind::kPolygons) return make_polygon_domain(options);
  if (options.input == InputKind::kSamples) return make_samples_domain(options);
  return make_volume_domain(options);
}

class MeshingRun {
 public:
  explicit MeshingRun(const MeshingOptions& options)
      : options_(options),
        console_(options.console),
        progress_(ProgressDisplay::style_for_stderr(options.console.quiet)),
        domain_(make_domain(options)) {}

  /// The steps, in order. `report` already holds what is known before the run.
  void run(Json report) {
    check_mesh_outputs(options_.output.paths, options_.volume.path);
    check_output(options_.report, options_.volume.path);
    std::vector<std::string> set_names;
    for (const NamedRule& rule : parse_sets(options_.output.sets, nullptr, true)) set_names.push_back(rule.name);
    analysis_ = read_analysis(options_.output);
    image_materials_ = parse_image_materials(options_.image_materials);
    if (image_materials_ && analysis_.material) throw OptionError("two materials: one from the image, one by name");
    if (analysis_.deck && !analysis_.material && !image_materials_) {
      throw OptionError(options_.output.deck + ": states no material; add \"material\", or give --material or --hu-density");
    }
    analysis_.check_sets(set_names, options_.output.deck);
    if (!options_.max_memory.empty()) max_bytes_ = parse_memory(options_.max_memory, "--max-memory");
    domain_->read(watch_, console_);
    check_image();
    sizes_ = decide_sizes(options_, *domain_, console_);
    mesh();
    check();
    write();
    tell(std::move(report));
    if (!verdict_.empty()) throw PromiseBroken(options_.output.paths.front() + ": written, but " + verdict_);
  }

 private:
  Variant variant() const;
  void mesh();
  double first_size();
  void search_size();
  void curve(const Oracle& oracle);
  void check_image() const;
  std::optional<MeshedImage> image() const;
  void map_materials();
  void name_sets();
  void mesh_at(const SizeField& size);
  void mesh_by_topology();
  ProcessForecast forecast_at(const Oracle& oracle, double factor) const;
  std::string uncounted() const;
  void look_ahead(const Oracle& oracle);
  [[noreturn]] void refuse(const Oracle& oracle, const ProcessForecast& forecast) const;
  SurfaceCriteria surface_criteria(const SizeField& size) const;
  void find_depths(const Oracle& oracle);
  TetCriteria tet_criteria(double factor) const;
  RunControl control();
  Mesh run_mesher(const Oracle& oracle);
  double min_dihedral_degrees() const;
  void remove_slivers_of(TetMesh& mesh, const Oracle& oracle);
  double meshing_seconds() const;
  void check();
  void write();
  void tell(Json report) const;
  Json report() const;
  std::string summary() const;

  const MeshingOptions& options_;
  Console console_;
  ProgressDisplay progress_;
  Stopwatch watch_;
  std::unique_ptr<MeshingDomain> domain_;
  MeshingSizes sizes_;
  std::optional<DepthField> depth_;  // with --grade, of the oracle at that size
  std::optional<double> max_bytes_;
  std::optional<Forecast> forecast_;
  Mesh mesh_;
  RunReport run_report_;
  std::optional<SliverReport> sliver_report_;
  CheckReport check_report_;
  Analysis analysis_;
  std::optional<ImageMaterialOptions> image_materials_;
  std::optional<ImageMaterialReport> material_report_;
  std::string set_fault_;
  std::string verdict_;
};

Variant MeshingRun::variant() const {
  return {options_.start == "persistent" ? Start::kPersistent : Start::kSeeds,
          options_.restricted == "all" ? Restricted::kAll : Restricted::kBipolar, options_.seed};
}

SurfaceCriteria MeshingRun::surface_criteria(const SizeField& size) const {
  SurfaceCriteria surface;
  surface.size = size;
  surface.min_angle_degrees = options_.min_angle_degrees;
  surface.max_deviation = options_.max_deviation.value_or(std::numeric_limits<double>::infinity());
  surface.min_ball_radius = options_.min_ball_radius.value_or(domain_->min_ball_radius(size));
  surface.max_roughness_degrees = options_.max_roughness_degrees.value_or(180);
  surface.feature_angle_degrees = options_.feature_angle_degrees.value_or(180);
  surface.min_smooth_radius = options_.min_ball_radius.value_or(domain_->min_smooth_radius(size));
  surface.thin_ball_radius = domain_->thin_ball_radius(size);
  return surface;
}

// --grade: how deep inside every place lies.
void MeshingRun::find_depths(const Oracle& oracle) {
  if (options_.grade == 0) return;
  depth_ = watch_.timed("depth", [&] {
    return DepthField(oracle, sizes_.size, [] {
      throw_if_cancelled();
      return true;
    });
  });
}

// With sizes `factor` times as large.
TetCriteria MeshingRun::tet_criteria(double factor) const {
  const SizeField size = scaled(sizes_.size, factor);
  if (!depth_) return {options_.radius_edge, sizes_.cell_size ? scaled(*sizes_.cell_size, factor) : size};
  const SizeField largest =
      sizes_.cell_size ? scaled(*sizes_.cell_size, factor) : std::numeric_limits<double>::infinity();
  return graded({options_.radius_edge, largest}, size, *depth_, options_.grade);
}

// What a run with sizes `factor` times as large is expected to take.
ProcessForecast MeshingRun::forecast_at(const Oracle& oracle, double factor) const {
  const SurfaceCriteria surface = surface_criteria(scaled(sizes_.size, factor));
  const Forecast mesh = options_.kind == MeshKind::kSurface ? forecast_surface(oracle, surface)
                                                            : forecast_tets(oracle, surface, tet_criteria(factor));
  return {limited(mesh, options_.limits.max_vertices), process_memory()};
}

// What forecasts leave out.
std::string MeshingRun::uncounted() const {
  if (options_.max_roughness_degrees) return options_.max_deviation ? "deviation and roughness" : "roughness";
  return options_.max_deviation ? "deviation" : "";
}

// Says what is to be expected, once for all runs of --tets, and refuses what is too much.
void MeshingRun::look_ahead(const Oracle& oracle) {
  const ProcessForecast forecast = watch_.timed("forecast", [&] { return forecast_at(oracle, 1); });
  if (forecast_) {
    console_.detail(describe(forecast, uncounted()));
  } else {
    console_.note(describe(forecast, uncounted()));
  }
  forecast_ = forecast.mesh;
  if (max_bytes_ && !(forecast.peak_bytes() <= *max_bytes_)) refuse(oracle, forecast);
}

void MeshingRun::refuse(const Oracle& oracle, const ProcessForecast& forecast) const {
  const auto factor = factor_that_fits([&](double f) { return forecast_at(oracle, f); }, *max_bytes_);
  std::string mend = "no size would fit; " + domain_->how_to_shrink();
  if (factor && sizes_.size.constant() && (!sizes_.cell_size || sizes_.cell_size->constant())) {
    mend = "--size " + rounded_up(*factor * sizes_.size.maximum());
    if (sizes_.cell_size) mend += " with --cell-size " + rounded_up(*factor * sizes_.cell_size->maximum());
    mend += options_.tets > 0 ? " in place of --tets would fit" : " would fit";
  } else if (factor) {
    mend = "sizes " + rounded_up(*factor) + " times as large would fit";
  }
  if (factor) mend += ", with " + elements(forecast_at(oracle, *factor).mesh);
  const std::string name = options_.implicit.empty() ? options_.volume.path : "--implicit";
  throw RunRefused(name + ": the forecast of " + memory_text(forecast.peak_bytes()) +
                   " exceeds --max-memory " + options_.max_memory + "; " + mend);
}

RunControl MeshingRun::control() {
  RunControl control;
  control.limits = options_.limits;
  if (control.limits.max_seconds > 0) {  // what earlier runs of --tets, or refinement, have left of it
    control.limits.max_seconds = std::max(1e-3, control.limits.max_seconds - meshing_seconds());
  }
  control.on_progress = [this](const Progress& progress) { progress_.show(progress); };
  control.cancel = &cancel_requested();
  return control;
}

// Of tets, whether asked for or by default; 0: slivers stay.
double MeshingRun::min_dihedral_degrees() const {
  return options_.min_dihedral_degrees.value_or(kDefaultMinDihedralDegrees);
}

// One run of the book's algorithm.
Mesh MeshingRun::run_mesher(const Oracle& oracle) {
  const SurfaceCriteria surface = surface_criteria(sizes_.size);
  return watch_.timed("meshing", [&]() -> Mesh {
    if (options_.kind == MeshKind::kTets) {
      const double min_fold = min_fold_for(min_dihedral_degrees());
      return deltetsurf(oracle, {surface, tet_criteria(1), control(), variant(), min_fold}, run_report_);
    }
    const auto mesher = options_.algorithm == "delsurf1" ? delsurf1 : delsurf;
    return mesher(oracle, {surface, control(), variant(), options_.surface_only_after_dense}, run_report_);
  });
}

// A bound that was asked for is promised, so that the check fails where it does not hold.
void MeshingRun::remove_slivers_of(TetMesh& mesh, const Oracle& oracle) {
  const double bound = min_dihedral_degrees();
  if (bound == 0 || run_report_.stop != StopReason::kFinished) return;
  const RemoveSliversOptions options{bound, surface_criteria(sizes_.size), tet_criteria(1), control()};
  sliver_report_ = watch_.timed("slivers", [&] { return remove_slivers(mesh, oracle, options, run_report_); });
  if (options_.min_dihedral_degrees) mesh.info.promises.min_dihedral_degrees = bound;
}

double MeshingRun::meshing_seconds() const {
  double seconds = 0;
  for (const StageTime& stage : watch_.stages()) {
    if (stage.stage == "meshing" || stage.stage == "slivers") seconds += stage.seconds;
  }
  return seconds;
}

void MeshingRun::mesh_at(const SizeField& size) {
  sizes_.size = size;
  const auto oracle = domain_->make_oracle(size, watch_);
  throw_if_cancelled();
  find_depths(*oracle);
  look_ahead(*oracle);
  throw_if_cancelled();
  mesh_ = run_mesher(*oracle);
  sliver_report_.reset();
  if (auto* tets = std::get_if<TetMesh>(&mesh_)) remove_slivers_of(*tets, *oracle);
  progress_.clear();
  if (options_.output.order == 2) watch_.timed("second order", [&] { curve(*oracle); });
  tell_effort(console_, run_report_, sliver_report_);
  if (options_.surface_only_after_dense) tell_dense(console_, run_report_);
}

// DelSurf2, which needs no oracle, nor a size.
void MeshingRun::mesh_by_topology() {
  const std::optional<SmoothDomain> domain = domain_->smooth();
  mesh_ = watch_.timed("meshing", [&] {
    return delsurf2(*domain, {surface_criteria(sizes_.size), control()}, run_report_);
  });
  progress_.clear();
  tell_effort(console_, run_report_, sliver_report_);
}

// Mid-side nodes, those of the boundary on the isosurface; what is not is told.
void MeshingRun::curve(const Oracle& oracle) {
  const SecondOrderReport report = make_second_order(std::get<TetMesh>(mesh_), &oracle);
  console_.detail("mid-side nodes of the boundary: " + grouped(report.boundary_edges) + ", on the isosurface " +
                  grouped(report.on_surface));
  const auto tell = [&](std::size_t count, const Point3& where, const char* reason) {
    if (count > 0) run_report_.unmet.push_back({"curved edges", count, where, reason, false});
  };
  tell(report.straightened, report.where_straightened, "straightened, or a tet would have turned inside out");
  tell(report.not_found, report.where_not_found, "left straight, no surface near their middle");
}

std::optional<MeshedImage> MeshingRun::image() const {
  if (const auto header = domain_->image()) return MeshedImage{*header, domain_->frame()};
  return std::nullopt;
}

// Refuses, before meshing, what only an image has.
void MeshingRun::check_image() const {
  const std::optional<MeshedImage> there = image();
  parse_sets(options_.output.sets, there ? &*there : nullptr);
  if (image_materials_ && !there) throw OptionError("--hu-density takes the samples of a volume; there is none");
}

// --hu-density: what the tets are made of, from the samples.
void MeshingRun::map_materials() {
  if (!image_materials_) return;
  const std::optional<Volume> samples =
      watch_.timed("reading", [&] { return domain_->samples(options_.image_materials.peel); });
  auto& tets = std::get<TetMesh>(mesh_);
  material_report_ =
      watch_.timed("materials", [&] { return assign_image_materials(tets, *samples, *image_materials_); });
  std::string text = plural(tets.materials.size(), "material") + ", modulus " + number(material_report_->least_mpa) +
                     " to " + number(material_report_->greatest_mpa) + " MPa, mean " +
                     number(material_report_->mean_mpa) + "; " + image_materials_->law.name + " (" +
                     image_materials_->law.density + " density)";
  if (material_report_->thin_share > 0) {
    text += "; density below 0.01 g/cm3, taken for it, in " + number(100 * material_report_->thin_share, 2) +
            " % of the volume";
  }
  console_.note(text);
}

// --set: places by name, in the output frame; and what the body is made of.
void MeshingRun::name_sets() {
  auto* tets = std::get_if<TetMesh>(&mesh_);
  if (tets == nullptr) return;
  analysis_.apply_material(*tets);
  const std::optional<MeshedImage> frame_and_header = image();
  set_fault_ = apply_sets(*tets, parse_sets(options_.output.sets, frame_and_header ? &*frame_and_header : nullptr));
  if (!set_fault_.empty() && analysis_.deck) {
    set_fault_ += "; the deck is left out";
    analysis_.deck.reset();
  }
  for (const MeshSet& set : tets->sets) {
    console_.note("set " + set.name + ": " + plural(set.nodes.size(), "node") + ", " + plural(set.tets.size(), "tet") +
                  ", " + plural(set.faces.size(), "boundary face"));
  }
}

// Where --tets begins. With --grade, tets do not go with the inverse cube of the size: the forecast knows better.
double MeshingRun::first_size() {
  const double guess = domain_->guess_size(options_.tets);
  if (options_.grade == 0) return guess;
  sizes_.size = guess;
  double factor = 1;
  try {
    const auto oracle = domain_->make_oracle(sizes_.size, watch_);
    find_depths(*oracle);
    for (int step = 0; step < 4; ++step) {
      const double tets = forecast_at(*oracle, factor).mesh.likely.tets;
      if (!(tets > 0)) return guess;
      factor *= std::pow(tets / static_cast<double>(options_.tets), 1 / 2.5);
    }
  } catch (const NothingToMesh&) {
    return guess;  // too small for the default of --min-component, perhaps; the search will tell
  }
  return factor * guess;
}

// --tets: meshes at sizes that close in on the wanted number. A size whose default --min-component takes everything out
// has too few tets.
void MeshingRun::search_size() {
  double last_size = 0;
  const SizeSearch found = find_size(options_.tets, first_size(), [&](double size) -> std::optional<std::size_t> {
    last_size = size;
    try {
      mesh_at(size);
    } catch (const NothingToMesh&) {
      if (!domain_->may_vanish()) throw;  // no size helps
      console_.note("size " + number(size) + " mm: all components are below the default of --min-component");
      return 0;
    }
    const std::size_t tets = std::get<TetMesh>(mesh_).tets.size();
    console_.note("size " + number(size) + " mm: " + plural(tets, "tet"));
    if (run_report_.stop != StopReason::kFinished) return std::nullopt;
    return tets;
  });
  const bool nothing_yet = found.tets == 0 && found.end != SearchEnd::kStopped;
  if (found.size != last_size || nothing_yet) mesh_at(found.size);
  sizes_.sentence = describe(found, options_.tets);
  console_.note(sizes_.sentence);
}

void MeshingRun::mesh() {
  find_on_surface(sizes_, options_, *domain_, watch_, console_);
  if (options_.algorithm == "delsurf2") {
    mesh_by_topology();
  } else if (options_.tets == 0) {
    mesh_at(sizes_.size);
  } else {
    search_size();
  }
  if (const std::string text = domain_->left_out(); !text.empty()) console_.note(text);
  domain_->finish(mesh_);
  map_materials();
  const FrameChange frame = domain_->frame();
  frame.apply(mesh_);
  frame.apply(run_report_);
  if (sliver_report_) frame.apply(*sliver_report_);
  apply_unit(options_.output.unit, mesh_);
  name_sets();
}

void MeshingRun::check() {
  throw_if_cancelled();
  CheckOptions cheap;
  cheap.level = CheckLevel::kCheap;
  std::optional<Mesh> polygons;  // in the frame of the mesh
  if (const SurfaceMesh* surface = domain_->polygons(); surface != nullptr && options_.feature_angle_degrees) {
    domain_->frame().apply(polygons.emplace(*surface));
    cheap.surface = &std::get<SurfaceMesh>(*polygons);
    cheap.feature_angle_degrees = options_.feature_angle_degrees;
  }
  check_report_ = watch_.timed("checking", [&] { return check_mesh(mesh_, cheap); });
  if (run_report_.succeeded()) {
    if (auto unmet = domain_->shortfall(check_report_)) run_report_.unmet.push_back(std::move(*unmet));
  }
  verdict_ = verdict(run_report_, check_report_);
  if (!verdict_.empty() && run_report_.stop == StopReason::kFinished) {
    verdict_ = verdict(run_report_, check_report_, domain_->advice());
  }
  if (!verdict_.empty()) std::visit([](auto& mesh) { mesh.info.complete = false; }, mesh_);
  if (verdict_.empty()) verdict_ = set_fault_;
}

void MeshingRun::write() {
  watch_.timed("writing", [&] { write_mesh_outputs(mesh_, options_.output.paths, console_, analysis_.deck); });
}

Json MeshingRun::report() const {
  Json json = domain_->report();
  json.update({{"size", sizes_.sentence},
               {"largest_size_mm", sizes_.size.maximum()},
               {"forecast", forecast_ ? to_json(*forecast_) : Json()},
               {"peak_bytes", process_memory().peak},
               {"mesh", to_json(std::visit([](const auto& mesh) { return mesh.info; }, mesh_))},
               {"sets", sets_json(mesh_)},
               {"materials", materials_json(mesh_)},
               {"run", to_json(run_report_)},
               {"slivers", sliver_report_ ? to_json(*sliver_report_) : Json()},
               {"check", to_json(check_report_)},
               {"seconds", watch_.total()},
               {"stages", to_json(watch_.stages())},
               {"mesher_stages", to_json(run_report_.stages)},
               {"outputs", options_.output.paths},
               {"verdict", verdict_.empty() ? "every promise verified" : verdict_}});
  return json;
}

std::string MeshingRun::summary() const {
  std::string text = to_text(check_report_);
  for (const Unmet& unmet : run_report_.unmet) {
    if (!unmet.breaks_promise) text += "left over: " + describe(unmet) + "\n";
  }
  if (const std::string left_out = domain_->left_out(); !left_out.empty()) text += left_out + "\n";
  text += domain_->sentence() + "; " + sizes_.sentence + "; frame " + to_string(domain_->frame().target()) + "\n";
  std::string times;
  for (const StageTime& stage : watch_.stages()) {
    if (stage.seconds >= 0.005) times += (times.empty() ? "" : ", ") + stage.stage + " " + number(stage.seconds, 3);
  }
  text += number(watch_.total(), 3) + " s: " + times + "\n";
  for (const std::string& path : options_.output.paths) text += path + "\n";
  return text;
}

// The report to its file and to the console.
void MeshingRun::tell(Json json) const {
  json.update(report());
  if (!options_.report.empty()) write_json(json, options_.report);
  if (console_.json()) console_.machine_result(text_of(json));
  if (sliver_report_) warn_of_slivers(console_, *sliver_report_);
  console_.result(summary());
}

}  // namespace

void run_meshing(const Verb& verb, const Arguments& arguments, MeshKind kind, InputKind input) {
  CLI::App app(std::string(verb.summary) + "\n", std::string("delvox ") + verb.name);
  MeshingOptions options;
  options.kind = kind;
  options.input = input;
  add_meshing_options(app, options);
  const ThreadLimit threads(app);
  if (!parse_arguments(app, arguments)) return;
  decide_input(app, options);
  Json report = run_header(verb, arguments);
  report["options"] = options_json(app);
  try {
    MeshingRun(options).run(std::move(report));
  } catch (const NothingToMesh& error) {
    if (options.volume.path.empty()) throw;
    throw NothingToMesh(options.volume.path + ": " + error.what());
  }
}

}  // namespace delvox::tools
