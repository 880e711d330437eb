// A volume larger than memory: how fast it is loaded to bricks against merely decoding its slices, and the peak memory
// of a process that loads, meshes, verifies and writes it. Each step in a process of its own. See --help.
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <vector>

#include "bench_main.h"
#include "delvox/check/check_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/volume/read_volume.h"
#include "delvox/volume/voxel_topology.h"
#include "isolated.h"

namespace delvox::bench {
namespace {

struct Options {
  std::string volume;
  double iso = 0, voxels_per_size = 20;
  int repeat = 3, threads = 0;
  std::optional<double> most_megabytes, least_ratio;
};

class Measurement {
 public:
  explicit Measurement(const Options& options) : options_(options), surface_{options.iso, false} {}

  int run() {
    std::vector<double> decoding, loading;
    double bytes = 0;
    for (int round = 0; round < options_.repeat; ++round) {
      const Outcome decoded = isolated([this] { return decode(); });
      decoding.push_back(decoded.seconds);
      bytes = static_cast<double>(decoded.all_cells) * 2;
      loading.push_back(isolated([this] { return load_to_bricks(); }).seconds);
    }
    const Outcome meshed = isolated([this] { return mesh(); });
    const double ratio = median(decoding) / median(loading), megabytes = meshed.peak_bytes / (1 << 20);
    std::printf("%s: %.2f GB as 16 bits; %d runs, medians\n", options_.volume.c_str(), 1e-9 * bytes, options_.repeat);
    std::printf("decoding %.2f s, loading to bricks %.2f s: %.2f of the speed\n", median(decoding), median(loading),
                ratio);
    std::printf("whole run at %g voxels per size: %.2f s, %zu tets, peak %.0f MB\n", options_.voxels_per_size,
                meshed.seconds, meshed.mesh.tets, megabytes);
    bool held = true;
    if (options_.least_ratio && ratio < *options_.least_ratio) held = false, std::printf("TOO SLOW\n");
    if (options_.most_megabytes && megabytes > *options_.most_megabytes) held = false, std::printf("TOO MUCH MEMORY\n");
    return held ? 0 : 1;
  }

 private:
  Outcome isolated(const std::function<Outcome()>& work) const {
    const Outcome outcome = run_isolated([&] {
      std::optional<tbb::global_control> limit;
      if (options_.threads > 0) {
        limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options_.threads));
      }
      return work();
    });
    if (!outcome.ok) throw std::runtime_error(outcome.note.data());
    return outcome;
  }

  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }

  static Outcome outcome_of(const Meter& meter) {
    BenchRun run;
    meter.stop(run);
    Outcome outcome;
    outcome.ok = true;
    outcome.seconds = run.seconds;
    outcome.peak_bytes = run.peak_bytes;
    return outcome;
  }

  Outcome decode() const {
    const Meter meter;
    const VolumeSourcePtr source = open_volume(options_.volume);
    const auto reader = source->start();
    std::vector<float> slice(static_cast<std::size_t>(source->dims()[0]) * source->dims()[1]);
    for (int k = 0; k < source->dims()[2]; ++k) reader->read(1, slice.data());
    Outcome outcome = outcome_of(meter);
    outcome.all_cells = source->voxel_count();
    return outcome;
  }

  Outcome load_to_bricks() const {
    const Meter meter;
    const VolumeSourcePtr source = open_volume(options_.volume);
    const auto oracle = make_isosurface_oracle(load(*source, surface_), surface_);
    return outcome_of(meter);
  }

  Outcome mesh() const {
    const Meter meter;
    const VolumeSourcePtr source = open_volume(options_.volume);
    const Vector3 spacing = source->header().spacing();
    const double size = options_.voxels_per_size * std::min({spacing.x, spacing.y, spacing.z});
    const Volume volume = filter_components(load(*source, surface_), surface_,
                                            {.min_component_mm3 = 4.0 / 3 * std::numbers::pi * size * size * size})
                              .volume;
    const auto oracle = make_isosurface_oracle(volume, surface_);
    RunReport report;
    const Mesh mesh = deltetsurf(*oracle, program_options(volume, {.size = size, .cell_size = size}), report);
    CheckOptions cheap;
    cheap.level = CheckLevel::kCheap;
    const bool holds = check_mesh(mesh, cheap).all_hold();
    const auto path = std::filesystem::temp_directory_path() / ("streaming_bench_" + std::to_string(getpid()) + ".vtu");
    write_mesh(mesh, path);
    std::filesystem::remove(path);
    Outcome outcome = outcome_of(meter);
    outcome.ok = holds;
    if (!holds) set_note(outcome, "a promise does not hold");
    outcome.mesh.tets = std::get<TetMesh>(mesh).tets.size();
    return outcome;
  }

  Options options_;
  Isosurface surface_;
};

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app("A stack of slices larger than memory: speed of loading, peak memory of a run");
  app.add_option("VOLUME", options.volume, "A volume file, a folder or a glob of slices")->required();
  app.add_option("--iso", options.iso, "Isovalue")->required();
  app.add_option("--voxels-per-size", options.voxels_per_size, "Size to mesh at, in voxels")->check(CLI::PositiveNumber);
  app.add_option("--repeat", options.repeat, "Runs of decoding and of loading")->check(CLI::PositiveNumber);
  app.add_option("--threads", options.threads, "How many threads to use (default: all cores)")
      ->check(CLI::PositiveNumber);
  app.add_option("--at-most", options.most_megabytes, "Fail if the run's peak exceeds so many MB");
  app.add_option("--at-least", options.least_ratio, "Fail if loading is below this part of the speed of decoding");
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("streaming_bench", [&] { return Measurement(options).run(); });
}

}  // namespace
}  // namespace delvox::bench

int main(int argc, char** argv) {
  return delvox::bench::main_of(argc, argv);
}
