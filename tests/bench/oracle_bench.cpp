// Nanoseconds per trilinear sample: the table of bricks against OpenVDB's ConstAccessor with BoxSampler, at the places
// where meshing asks and at others. One thread; the two take turns, medians. See --help.

#include <openvdb/tools/Interpolation.h>
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>

#include "bench_image.h"
#include "bench_main.h"
#include "core/hash.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/volume/voxel_topology.h"
#include "oracle/brick_field.h"
#include "volume/volume_impl.h"

namespace delvox::bench {
namespace {

struct Options {
  std::string volume;
  std::optional<double> iso;
  double size = 0, smooth = 0;
  std::size_t samples = 2'000'000;
  int repeat = 7;
};

/// Passes all questions on, and keeps where the values are looked at, in world coordinates. Clones, which the mesher's
/// threads ask, keep it in the same place.
class RecordingOracle final : public Oracle {
 public:
  RecordingOracle(const Oracle& oracle, std::size_t most) : oracle_(oracle), most_(most) {}

  const std::vector<Point3>& labels() const { return kept_->labels; }
  const std::vector<Point3>& crossings() const { return kept_->crossings; }

  Box3 bounds() const override { return oracle_.bounds(); }
  Label label(const Point3& p) const override {
    keep(kept_->labels, p);
    return oracle_.label(p);
  }
  /// Bisection to a quarter of a millimetre and the crossing itself stand for the search.
  Point3 intersect(const Point3& a, const Point3& b) const override {
    const Point3 crossing = oracle_.intersect(a, b);
    Point3 low = a, high = b;
    const Label at_a = oracle_.label(a);
    keep(kept_->crossings, a);
    keep(kept_->crossings, b);
    while (squared_distance(low, high) > 0.0625) {
      const Point3 middle = midpoint(low, high);
      keep(kept_->crossings, middle);
      (oracle_.label(middle) == at_a ? low : high) = middle;
    }
    keep(kept_->crossings, crossing);
    return crossing;
  }
  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    return oracle_.intersect_all(a, b);
  }
  Seeds seeds(const SizeField& size, const GoOn& go_on) const override { return oracle_.seeds(size, go_on); }
  Landmarks landmarks(const SizeField& size, const GoOn& go_on) const override {
    return oracle_.landmarks(size, go_on);
  }
  std::unique_ptr<Oracle> clone() const override { return std::make_unique<RecordingOracle>(*this); }

 private:
  struct Kept {
    std::mutex mutex;
    std::vector<Point3> labels, crossings;
  };
  void keep(std::vector<Point3>& points, const Point3& p) const {
    const std::lock_guard lock(kept_->mutex);
    if (points.size() < most_) points.push_back(p);
  }

  const Oracle& oracle_;
  std::size_t most_;
  std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

/// Where to sample, in units of voxels of the image.
struct Pattern {
  const char* name;
  std::vector<Point3> points;
};

class OracleBench {
 public:
  explicit OracleBench(const Options& options)
      : options_(options),
        surface_{options.iso ? *options.iso : phantom_isovalue(options.volume), false},
        volume_(prepare_volume(options.volume, options.smooth)),
        field_(volume_, LevelSet(surface_)) {}

  int run() {
    std::vector<Pattern> patterns = recorded();
    patterns.push_back({"lines in steps of a quarter voxel", lines()});
    patterns.push_back({"eight at a time in random cells of mixed bricks", clusters()});
    patterns.push_back({"anywhere in the image", anywhere()});
    std::printf("%s: %d x %d x %d voxels, iso %g, size %g mm; medians of %d\n\n", options_.volume.c_str(),
                volume_.dims()[0], volume_.dims()[1], volume_.dims()[2], surface_.isovalue, size(), options_.repeat);
    std::printf("| %-48s | samples | bricks, ns | OpenVDB, ns | ratio |\n|%s|---:|---:|---:|---:|\n", "where",
                std::string(50, '-').c_str());
    std::size_t differ = 0;
    for (const Pattern& pattern : patterns) differ += compare(pattern);
    if (differ > 0) {
      std::printf("\nthe sides of %zu samples DIFFER\n", differ);
    } else {
      std::printf("\nsame side in all samples\n");
    }
    return differ > 0 ? 1 : 0;
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Accessor = openvdb::FloatGrid::ConstAccessor;

  double size() const {
    if (options_.size > 0) return options_.size;
    const Vector3 spacing = volume_.header().spacing();
    return 3 * std::cbrt(spacing.x * spacing.y * spacing.z);
  }

  std::size_t compare(const Pattern& pattern) {
    std::vector<double> bricks, openvdb;
    std::vector<bool> by_bricks(pattern.points.size()), by_openvdb(pattern.points.size());
    for (int round = 0; round < options_.repeat; ++round) {
      bricks.push_back(time(pattern.points, by_bricks, [this](const Point3& p) {
        return field_.inside({p.x + 1, p.y + 1, p.z + 1});
      }));
      const Accessor accessor = volume_.impl().grid->getConstAccessor();
      const double level = field_.level();
      openvdb.push_back(time(pattern.points, by_openvdb, [&](const Point3& p) {
        float value = 0;
        openvdb::tools::BoxSampler::sample(accessor, openvdb::Vec3R(p.x, p.y, p.z), value);
        return value > level;
      }));
    }
    const auto median = [](std::vector<double>& times) {
      std::sort(times.begin(), times.end());
      return times[times.size() / 2];
    };
    const double ours = median(bricks), theirs = median(openvdb);
    std::printf("| %-48s | %zu | %.1f | %.1f | %.1f |\n", pattern.name, pattern.points.size(), ours, theirs,
                theirs / ours);
    // OpenVDB interpolates in single precision: samples all but on the surface may fall on either side.
    std::size_t differ = 0;
    for (std::size_t i = 0; i < pattern.points.size(); ++i) {
      if (by_bricks[i] != by_openvdb[i]) differ += !on_surface(pattern.points[i]);
    }
    return differ;
  }

  bool on_surface(const Point3& p) const {
    return std::abs(field_.value({p.x + 1, p.y + 1, p.z + 1})) < 1e-5 * (1 + std::abs(field_.level()));
  }

  template <class Inside>
  static double time(const std::vector<Point3>& points, std::vector<bool>& sides, const Inside& inside) {
    const auto begin = Clock::now();
    for (std::size_t i = 0; i < points.size(); ++i) sides[i] = inside(points[i]);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return 1e9 * seconds / static_cast<double>(points.size());
  }

  /// What a run of deltetsurf asks for.
  std::vector<Pattern> recorded() const {
    const double cubed = size() * size() * size();
    const Volume clean =
        filter_components(volume_, surface_, {.min_component_mm3 = 4.0 / 3 * std::numbers::pi * cubed}).volume;
    const auto oracle = make_isosurface_oracle(clean, surface_);
    const RecordingOracle recorder(*oracle, options_.samples);
    DelTetSurfOptions meshing;
    meshing.surface.size = size();
    meshing.surface.min_ball_radius = 0.001 * size();
    meshing.tets.cell_size = size();
    RunReport report;
    deltetsurf(recorder, meshing, report);
    return {{"labels of circumcentres, as refinement asks", in_image(recorder.labels())},
            {"bisections of dual edges, as refinement asks", in_image(recorder.crossings())}};
  }

  std::vector<Point3> in_image(const std::vector<Point3>& world) const {
    const Affine3 to_index = volume_.header().index_to_world.inverse();
    std::vector<Point3> points;
    for (const Point3& p : world) {
      const Point3 u = to_index(p);
      bool within = true;
      for (int axis = 0; axis < 3; ++axis) within &= u[axis] >= 0 && u[axis] <= volume_.dims()[axis] - 1;
      if (within) points.push_back(u);
    }
    return points;
  }

  Point3 random_point() {
    Point3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = random() * (volume_.dims()[axis] - 1);
    return p;
  }
  double random() { return unit_interval(mix_hash(++draws_)); }

  std::vector<Point3> lines() {
    std::vector<Point3> points;
    while (points.size() < options_.samples) {
      const Point3 a = random_point(), b = random_point();
      const int steps = static_cast<int>(4 * distance(a, b)) + 1;
      for (int s = 0; s <= steps; ++s) points.push_back(a + (double(s) / steps) * (b - a));
    }
    points.resize(options_.samples);
    return points;
  }

  std::vector<Point3> clusters() {
    std::vector<Point3> centers, points;
    field_.for_each_mixed_brick([&](const std::array<int, 3>& brick) {
      Point3 center;
      for (int axis = 0; axis < 3; ++axis) center[axis] = (brick[axis] + 0.5) * BrickField::kBrick - 1;
      centers.push_back(center);
    });
    while (points.size() < options_.samples) {
      const Point3& center = centers[static_cast<std::size_t>(random() * static_cast<double>(centers.size()))];
      Point3 low;
      for (int axis = 0; axis < 3; ++axis) low[axis] = center[axis] + 6 * random() - 3;
      for (int n = 0; n < 8; ++n) {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis) {
          p[axis] = std::clamp(low[axis] + random(), 0.0, volume_.dims()[axis] - 1.0);
        }
        points.push_back(p);
      }
    }
    return points;
  }

  std::vector<Point3> anywhere() {
    std::vector<Point3> points;
    while (points.size() < options_.samples) points.push_back(random_point());
    return points;
  }

  Options options_;
  Isosurface surface_;
  Volume volume_;
  BrickField field_;
  std::uint64_t draws_ = 0;
};

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app("Nanoseconds per sample of the brick table and of OpenVDB's ConstAccessor with BoxSampler");
  app.add_option("VOLUME", options.volume, "A volume file, or phantom:KIND")->required();
  app.add_option("--iso", options.iso, "Isovalue (a phantom knows its own)");
  app.add_option("--size", options.size, "Of the mesh whose questions are recorded, mm (default: three voxels)");
  app.add_option("--smooth", options.smooth, "Gaussian smoothing first, sigma in mm");
  app.add_option("--samples", options.samples, "At most so many of each kind")->check(CLI::PositiveNumber);
  app.add_option("--repeat", options.repeat, "Rounds")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  return exit_code_of("oracle_bench", [&] { return OracleBench(options).run(); });
}

}  // namespace
}  // namespace delvox::bench

int main(int argc, char** argv) {
  return delvox::bench::main_of(argc, argv);
}
