// Memory per vertex: what a run takes above the loaded volume and its bricks until the mesh is extracted, and what
// verification and writing add to that peak. One thread, in a process of its own. See --help.
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>

#include "bench_main.h"
#include "delvox/check/check_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/volume/voxel_topology.h"
#include "isolated.h"

namespace delvox::bench {
namespace {

struct Options {
  std::string volume;
  std::optional<double> iso, most_meshing, most_after;
  double size = 0, smooth = 0;
};

/// Peaks above what the process held before meshing.
struct Peaks {
  double extracted, written;
};

class Measurement {
 public:
  explicit Measurement(const Options& options) : options_(options) {
    surface_ = {options.iso ? *options.iso : phantom_isovalue(options.volume), false};
  }

  int run() {
    const Outcome outcome = run_isolated([this] { return mesh_and_write(); });
    if (!outcome.ok) throw std::runtime_error(outcome.note.data());
    const Peaks peaks = peaks_.read_array<Peaks>().at(0);
    const double vertices = static_cast<double>(outcome.mesh.vertices);
    const double meshing = peaks.extracted / vertices, after = std::max(0.0, peaks.written - peaks.extracted) / vertices;
    std::printf("%s, iso %.6g, smooth %g mm, size %g mm: %zu tets, %zu vertices\n", options_.volume.c_str(),
                surface_.isovalue, options_.smooth, options_.size, outcome.mesh.tets, outcome.mesh.vertices);
    std::printf("%.0f bytes per vertex until the mesh is extracted, %.0f more to verify and write it\n", meshing, after);
    return held(meshing, options_.most_meshing, "meshing") && held(after, options_.most_after, "what follows") ? 0 : 1;
  }

 private:
  static bool held(double bytes, const std::optional<double>& most, const char* what) {
    if (!most || bytes <= *most) return true;
    std::printf("TOO MUCH: %s may take %.0f bytes per vertex\n", what, *most);
    return false;
  }

  Outcome mesh_and_write() const {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const double min_mm3 = 4.0 / 3 * std::numbers::pi * options_.size * options_.size * options_.size;
    const Volume volume =
        filter_components(prepare_volume(options_.volume, options_.smooth), surface_, {.min_component_mm3 = min_mm3})
            .volume;
    const auto oracle = make_isosurface_oracle(volume, surface_);
    const auto options = program_options(volume, {.size = options_.size, .cell_size = options_.size});
    RunReport report;
    Peaks peaks{};
    Outcome outcome;
    const Meter meter;
    const Mesh mesh = deltetsurf(*oracle, options, report);
    peaks.extracted = meter.peak_bytes();
    CheckOptions cheap;  // as the program does at the end of a run
    cheap.level = CheckLevel::kCheap;
    outcome.ok = check_mesh(mesh, cheap).all_hold();
    if (!outcome.ok) set_note(outcome, "a promise does not hold");
    const auto path = std::filesystem::temp_directory_path() / ("memory_bench_" + std::to_string(getpid()) + ".vtu");
    write_mesh(mesh, path);
    std::filesystem::remove(path);
    peaks.written = meter.peak_bytes();
    peaks_.write_array(std::vector{peaks});
    outcome.mesh.tets = std::get<TetMesh>(mesh).tets.size();
    outcome.mesh.vertices = std::get<TetMesh>(mesh).points.size();
    return outcome;
  }

  Options options_;
  Isosurface surface_;
  SharedBytes peaks_;
};

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app("Memory per vertex of meshing, and of verifying and writing");
  app.add_option("VOLUME", options.volume, "A volume file, or phantom:KIND")->required();
  app.add_option("--iso", options.iso, "Isovalue (a phantom knows its own)");
  app.add_option("--size", options.size, "Bound on surface ball radii and on circumradii, mm")
      ->required()
      ->check(CLI::PositiveNumber);
  app.add_option("--smooth", options.smooth, "Gaussian smoothing before all, sigma in mm");
  app.add_option("--at-most", options.most_meshing, "Fail if meshing takes more bytes per vertex");
  app.add_option("--then-at-most", options.most_after, "Fail if verifying and writing take more beyond it");
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("memory_bench", [&] { return Measurement(options).run(); });
}

}  // namespace
}  // namespace delvox::bench

int main(int argc, char** argv) {
  return delvox::bench::main_of(argc, argv);
}
