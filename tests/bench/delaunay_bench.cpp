// The limit that nobody who inserts every vertex can beat: bulk insertion of the final vertices of a mesh, by our
// kernel and by CGAL's, against the whole refinement that made them. Interleaved runs, medians, every run in a process
// of its own, one thread. See --help. Final numbers want an idle machine.

#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <functional>
#include <iostream>
#include <numbers>
#include <optional>

#include "bench_main.h"
#include "delvox/volume/voxel_topology.h"
#include "scoreboard.h"

namespace delvox::bench {
namespace {

struct Options {
  std::string volume;
  std::optional<double> iso;
  double size = 0, smooth = 0;
  int repeat = 3;
};

class Limit {
 public:
  explicit Limit(const Options& options) : options_(options) {
    surface_ = {options.iso ? *options.iso : phantom_isovalue(options.volume), false};
  }

  int run() {
    std::vector<Column> columns{{"delvox", false, {}}, {"our bulk insertion", true, {}}, {"CGAL's", true, {}}};
    for (int round = 0; round < options_.repeat; ++round) {
      columns[0].runs.push_back(isolated([this] { return refine(); }));
      columns[1].runs.push_back(isolated([this] { return insert(run_kernel_insertion); }));
      columns[2].runs.push_back(isolated([this] { return insert(run_bulk_insertion); }));
    }
    std::printf("%s, iso %.6g, smooth %g mm, size %g mm, %d runs each\n\n%s", options_.volume.c_str(),
                surface_.isovalue, options_.smooth, options_.size, options_.repeat, scoreboard(columns).c_str());
    for (const Column& column : columns) {
      for (const Outcome& outcome : column.runs) {
        if (!outcome.ok) throw std::runtime_error(column.name + " failed: " + outcome.note.data());
      }
    }
    const auto seconds = [&](int column) { return median_run(columns[static_cast<std::size_t>(column)]).seconds; };
    std::printf("The refinement takes %.2f times our bulk insertion, %.2f times CGAL's; ours is %.2f times as fast.\n",
                seconds(0) / seconds(1), seconds(0) / seconds(2), seconds(2) / seconds(1));
    std::printf("delvox: %s\n", median_run(columns[0]).note.data());
    return 0;
  }

 private:
  static Outcome isolated(const std::function<Outcome()>& work) {
    return run_isolated([&] {
      const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
      return work();
    });
  }

  Outcome refine() const {
    const double min_mm3 = 4.0 / 3 * std::numbers::pi * options_.size * options_.size * options_.size;
    const Volume volume =
        filter_components(prepare_volume(options_.volume, options_.smooth), surface_, {.min_component_mm3 = min_mm3})
            .volume;
    const BenchRun run = run_delvox(volume, surface_, {.size = options_.size, .cell_size = options_.size});
    points_.write_array(run.mesh.points);
    Outcome outcome = outcome_of(run);
    outcome.mesh = measure(run.mesh, make_bench_image(volume, surface_));
    return outcome;
  }

  Outcome insert(BenchRun (*insertion)(const std::vector<Point3>&)) const {
    const auto points = points_.read_array<Point3>();
    Outcome outcome = outcome_of(insertion(points));
    outcome.mesh.vertices = points.size();
    return outcome;
  }

  static Outcome outcome_of(const BenchRun& run) {
    Outcome outcome;
    outcome.ok = true;
    outcome.seconds = run.seconds;
    outcome.cpu_seconds = run.cpu_seconds;
    outcome.peak_bytes = run.peak_bytes;
    outcome.all_cells = run.all_cells;
    set_note(outcome, run.note);
    return outcome;
  }

  Options options_;
  Isosurface surface_;
  SharedBytes points_;  // of the last mesh
};

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app("Bulk insertion of a mesh's vertices against the refinement that made them");
  app.add_option("VOLUME", options.volume, "A volume file, or phantom:KIND")->required();
  app.add_option("--iso", options.iso, "Isovalue (a phantom knows its own)");
  app.add_option("--size", options.size, "Bound on surface ball radii and on circumradii, mm")
      ->required()
      ->check(CLI::PositiveNumber);
  app.add_option("--smooth", options.smooth, "Gaussian smoothing before all, sigma in mm");
  app.add_option("--repeat", options.repeat, "Runs of each")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("delaunay_bench", [&] { return Limit(options).run(); });
}

}  // namespace
}  // namespace delvox::bench

int main(int argc, char** argv) {
  return delvox::bench::main_of(argc, argv);
}
