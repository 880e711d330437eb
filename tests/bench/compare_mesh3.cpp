// delvox against CGAL's Mesh_3 on one thread: the same image, the same criteria, interleaved runs, medians; every run
// in a process of its own. See --help. Final numbers want an idle machine.

#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <optional>

#include "bench_main.h"
#include "delvox/mesh_io/write_mesh.h"
#include "delvox/volume/voxel_topology.h"
#include "scoreboard.h"

namespace delvox::bench {
namespace {

enum class Contender { kDelvox, kSequential, kParallel, kBulk };
constexpr const char* kNames[] = {"delvox", "CGAL sequential", "CGAL parallel", "bulk insertion"};

struct Options {
  std::string volume;
  std::optional<double> iso, size, cell_size, min_component;
  std::size_t tets = 0;
  double smooth = 0;
  int repeat = 3, threads = 1;
  bool below = false, optimise = false;
  Mesh3Choices mesh3;
  std::string mesh3_domain = "image", mesh3_seeds = "default";
  std::vector<std::string> only{"ours", "seq", "par", "bulk"};
  std::string write_prefix, csv;
};

/// What run_isolated's processes share: the volume after smoothing, and the points of delvox's mesh.
struct Arena {
  struct Shape {
    std::array<int, 3> dims{};
    Vector3 spacing;
    double inside_mm3 = 0;
  };
  SharedBytes shape, samples, points;

  Shape read_shape() const { return shape.read_array<Shape>().at(0); }
  Volume volume() const {
    const Shape s = read_shape();
    VolumeHeader header;
    header.dims = s.dims;
    for (int axis = 0; axis < 3; ++axis) header.index_to_world.rows[axis][axis] = s.spacing[axis];
    return Volume(header, samples.read_array<float>());
  }
};

class Comparison {
 public:
  explicit Comparison(const Options& options) : options_(options) {
    surface_ = {options.iso ? *options.iso : phantom_isovalue(options.volume), options.below};
  }

  int run() {
    prepare();
    const double size = options_.tets > 0 ? search_size(options_.tets) : *options_.size;
    print_setting(size);
    std::vector<Column> columns;
    for (const Contender contender : chosen())
      columns.push_back({kNames[int(contender)], contender == Contender::kBulk, {}});
    const auto contenders = chosen();
    if (contenders.front() == Contender::kBulk) run_once(Contender::kDelvox, size);  // for its points
    for (int round = 0; round < options_.repeat; ++round) {
      for (std::size_t i = 0; i < contenders.size(); ++i) columns[i].runs.push_back(run_once(contenders[i], size));
    }
    std::cout << scoreboard(columns) << verdict(columns);
    if (!options_.csv.empty()) append_csv(columns, size);
    return print_notes(columns) ? 0 : 1;
  }

 private:
  std::vector<Contender> chosen() const {
    std::vector<Contender> list;
    const char* const keys[] = {"ours", "seq", "par", "bulk"};
    for (int i = 0; i < 4; ++i) {
      if (std::count(options_.only.begin(), options_.only.end(), keys[i])) list.push_back(Contender(i));
    }
    return list;
  }

  void prepare() {
    const Outcome outcome = run_isolated([this] {
      const Volume volume = prepare_volume(options_.volume, options_.smooth);
      const LevelSet level_set(surface_);
      const std::vector<float> samples = volume.samples();
      Arena::Shape shape{volume.dims(), volume.header().spacing(), 0};
      const auto inside =
          std::count_if(samples.begin(), samples.end(), [&](float s) { return level_set.inside(level_set.sign * s); });
      shape.inside_mm3 = static_cast<double>(inside) * shape.spacing.x * shape.spacing.y * shape.spacing.z;
      if (inside == 0) throw std::runtime_error("no sample is inside");  // CGAL would look for one for ever
      arena_.samples.write_array(samples);
      arena_.shape.write_array(std::vector{shape});
      Outcome done;
      done.ok = true;
      return done;
    });
    if (!outcome.ok) throw std::runtime_error(outcome.note.data());
  }

  BenchCriteria criteria(double size) const {
    BenchCriteria bounds;
    bounds.size = size;
    bounds.cell_size = options_.cell_size.value_or(size);
    bounds.optimise = options_.optimise;
    return bounds;
  }

  Outcome run_once(Contender contender, double size) {
    return run_isolated([&] { return contend(contender, size); });
  }

  /// In a process of its own. Every run is measured: CGAL's parallel tag gives another mesh each time.
  Outcome contend(Contender contender, double size) const {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(options_.threads));
    Outcome outcome;
    BenchRun run;
    if (contender == Contender::kBulk) {
      const auto points = arena_.points.read_array<Point3>();
      run = run_bulk_insertion(points);
      outcome.mesh.vertices = points.size();
    } else {
      const Volume volume = without_specks(size);
      run = contender == Contender::kDelvox
                ? run_delvox(volume, surface_, criteria(size))
                : run_mesh3(make_bench_image(volume, surface_), criteria(size), tagged(contender));
      outcome.mesh = measure(run.mesh, make_bench_image(volume, surface_));
      if (!options_.write_prefix.empty()) write(contender, run.mesh);
      if (contender == Contender::kDelvox) arena_.points.write_array(run.mesh.points);
    }
    outcome.ok = true;
    outcome.seconds = run.seconds;
    outcome.cpu_seconds = run.cpu_seconds;
    outcome.peak_bytes = run.peak_bytes;
    outcome.all_cells = run.all_cells;
    set_note(outcome, run.note);
    return outcome;
  }

  double min_component_mm3(double size) const {
    return options_.min_component.value_or(4.0 / 3 * std::numbers::pi * size * size * size);
  }

  Volume without_specks(double size) const {
    return filter_components(arena_.volume(), surface_, {.min_component_mm3 = min_component_mm3(size)}).volume;
  }

  Mesh3Choices tagged(Contender contender) const {
    Mesh3Choices choices = options_.mesh3;
    choices.parallel_tag = contender == Contender::kParallel;
    return choices;
  }

  void write(Contender contender, TetMesh mesh) const {
    const char* const suffix[] = {"delvox", "cgal_sequential", "cgal_parallel"};
    mesh.boundary = boundary_of(mesh.tets);
    write_mesh(mesh, options_.write_prefix + "_" + suffix[int(contender)] + ".vtu");
  }

  /// The number of tets goes with size^-3, and with size^-2 where the surface takes most of them.
  double search_size(std::size_t wanted) {
    double size = std::cbrt(8 * arena_.read_shape().inside_mm3 / static_cast<double>(wanted));
    double best = size, best_error = HUGE_VAL;
    for (int attempt = 0; attempt < 6 && best_error > 0.02; ++attempt) {
      const Outcome outcome = run_once(Contender::kDelvox, size);
      if (!outcome.ok || outcome.mesh.tets == 0)
        throw std::runtime_error("no mesh: " + std::string(outcome.note.data()));
      const double ratio = static_cast<double>(outcome.mesh.tets) / static_cast<double>(wanted);
      std::fprintf(stderr, "size %.6g mm: %zu tets in %.2f s\n", size, outcome.mesh.tets, outcome.seconds);
      if (std::abs(std::log(ratio)) < best_error) best_error = std::abs(std::log(ratio)), best = size;
      size *= std::cbrt(ratio);
    }
    return std::strtod(rounded(best).c_str(), nullptr);
  }

  static std::string rounded(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof(buffer), "%.4g", value);
    return buffer;
  }

  void print_setting(double size) const {
    const Arena::Shape shape = arena_.read_shape();
    std::printf("%s: %d x %d x %d voxels of %.4g x %.4g x %.4g mm, iso %.6g, smooth %g mm, min component %.4g mm3\n",
                options_.volume.c_str(), shape.dims[0], shape.dims[1], shape.dims[2], shape.spacing.x, shape.spacing.y,
                shape.spacing.z, surface_.isovalue, options_.smooth, min_component_mm3(size));
    std::printf("size %.6g mm, cell size %.6g mm, angle 30, radius-edge 2; CGAL domain: %s, seeds: %s, %s\n", size,
                criteria(size).cell_size, options_.mesh3_domain.c_str(), options_.mesh3_seeds.c_str(),
                options_.mesh3.manifold ? "manifold" : "facet vertices on surface");
    std::ifstream load("/proc/loadavg");
    std::string minute;
    load >> minute;
    if (options_.optimise) std::printf("then slivers: ours removed up to 15 degrees; CGAL's perturbed and exuded\n");
    std::printf("%d runs each, interleaved; %d thread(s); load average %s before the first\n\n", options_.repeat,
                options_.threads, minute.c_str());
    std::fflush(stdout);
  }

  /// One file may take many comparisons: what was compared is in every line.
  void append_csv(const std::vector<Column>& columns, double size) const {
    const bool is_new = !std::filesystem::exists(options_.csv);
    std::ofstream out(options_.csv, std::ios::app);
    if (is_new) out << "volume,iso,smooth,size,threads," << csv_names() << "\n";
    char numbers[128];
    std::snprintf(numbers, sizeof(numbers), ",%.9g,%g,%.6g,%d", surface_.isovalue, options_.smooth, size,
                  options_.threads);
    out << csv_rows(columns, std::filesystem::path(options_.volume).filename().string() + numbers);
    if (!out.flush()) throw std::runtime_error(options_.csv + ": cannot be written");
  }

  static bool print_notes(const std::vector<Column>& columns) {
    bool all_ok = true;
    for (const Column& column : columns) {
      const auto bad = std::find_if(column.runs.begin(), column.runs.end(), [](const Outcome& r) { return !r.ok; });
      const Outcome& run = bad != column.runs.end() ? *bad : median_run(column);
      all_ok &= run.ok;
      if (run.note[0]) std::cout << column.name << (run.ok ? ": " : " failed: ") << run.note.data() << "\n";
    }
    return all_ok;
  }

  Options options_;
  Isosurface surface_;
  Arena arena_;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("VOLUME", options.volume, "A volume file, or phantom:KIND")->required();
  app.add_option("--iso", options.iso, "Isovalue (a phantom knows its own)");
  app.add_flag("--below", options.below, "Inside is below the isovalue");
  auto* size = app.add_option("--size", options.size, "Bound on surface ball radii, mm")->check(CLI::PositiveNumber);
  auto* tets = app.add_option("--tets", options.tets, "Instead: the size at which delvox gives about so many tets");
  size->excludes(tets);
  app.add_option("--cell-size", options.cell_size, "Bound on circumradii, mm (default: --size)")
      ->check(CLI::PositiveNumber);
  app.add_option("--smooth", options.smooth, "Gaussian smoothing before all contenders, sigma in mm");
  app.add_option("--min-component", options.min_component,
                 "Smaller components and cavities are taken out first, mm3 (default: one surface ball)");
  app.add_option("--repeat", options.repeat, "Runs of each contender")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "For all contenders")->check(CLI::PositiveNumber);
  app.add_option("--only", options.only, "Which contenders: ours, seq, par, bulk")
      ->delimiter(',')
      ->check(CLI::IsMember({"ours", "seq", "par", "bulk"}));
  app.add_option("--cgal-domain", options.mesh3_domain,
                 "image: CGAL::Image_3; function: our trilinear labelling function")
      ->check(CLI::IsMember({"image", "function"}));
  app.add_option("--cgal-seeds", options.mesh3_seeds,
                 "default: CGAL's random rays; components: one for each voxel component")
      ->check(CLI::IsMember({"default", "components"}));
  app.add_option("--cgal-error-bound", options.mesh3.error_bound, "Of CGAL's bisection, relative to the bounding box");
  app.add_flag("--optimise", options.optimise,
               "With what each does against slivers: ours remove_slivers at 15 degrees, CGAL's perturb and exude");
  app.add_flag("--cgal-manifold", options.mesh3.manifold, "Ask CGAL for a manifold boundary");
  app.add_option("--write", options.write_prefix, "Write each mesh (of the last run) to PREFIX_contender.vtu");
  app.add_option("--csv", options.csv, "Append the figures to this file of comma-separated values");
}

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app("delvox against CGAL Mesh_3: same image, same criteria");
  declare(app, options);
  CLI11_PARSE(app, argc, argv);
  options.mesh3.function_domain = options.mesh3_domain == "function";
  options.mesh3.component_seeds = options.mesh3_seeds == "components";
  return exit_code_of("compare_mesh3", [&] {
    if (!options.size && options.tets == 0) throw std::runtime_error("one of --size and --tets is needed");
    return Comparison(options).run();
  });
}

}  // namespace
}  // namespace delvox::bench

int main(int argc, char** argv) {
  return delvox::bench::main_of(argc, argv);
}
