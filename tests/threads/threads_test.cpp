// Every step of a run outside the mesher, by 1, 2 and 4 threads: the same to the last bit. Under ThreadSanitizer
// (label tsan) it is also held that they do not race.
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "delvox/check/check_mesh.h"
#include "delvox/mesh_io/write_mesh.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "delvox/volume/histogram.h"
#include "delvox/volume/phantom.h"
#include "delvox/volume/preprocess.h"
#include "delvox/volume/voxel_topology.h"
#include "support/test_volumes.h"

namespace delvox {
namespace {

constexpr Isosurface kSurface{0.1, false};

/// What `work` returns when it may use so many threads, even on a machine with fewer cores.
template <class Work>
auto by_threads(int threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  return tbb::task_arena(threads).execute(work);
}

template <class Work>
void expect_same_for_any_threads(const Work& work) {
  const auto by_one = by_threads(1, work);
  for (int threads : {2, 4}) EXPECT_TRUE(by_threads(threads, work) == by_one) << threads;
}

/// Hundreds of bumps and some specks and cavities, 58 x 50 x 44 voxels: several bricks, chunks and slabs of everything.
const Volume& bumps() {
  static const Volume volume = test::volume_of({58, 50, 44}, [](double x, double y, double z) {
    const double waves = std::sin(0.55 * x) * std::sin(0.5 * y) * std::sin(0.6 * z);
    return waves + 0.4 * std::sin(0.21 * x + 0.13 * y * y / 40) - 0.2;
  });
  return volume;
}

TEST(Threads, FiltersAndLoadingGiveTheSameSamples) {
  expect_same_for_any_threads([] {
    const VolumeSourcePtr source = resample(smooth(source_of(bumps()), {0.8}), {1.3});
    std::vector<float> samples = load(*source).samples();
    const std::vector<float> near_surface = load(*source, kSurface).samples();
    samples.insert(samples.end(), near_surface.begin(), near_surface.end());
    return samples;
  });
}

TEST(Threads, StatisticsGiveTheSameIsovalues) {
  expect_same_for_any_threads([] {
    const VolumeSourcePtr source = source_of(bumps());
    const SampleStatistics statistics(*source);
    std::vector<double> found = statistics.otsu_isovalues(3);
    const std::array<double, 2> percents{3, 97.5};
    for (double value : statistics.percentiles(percents)) found.push_back(value);
    return found;
  });
}

TEST(Threads, RegionsAreCountedAndFilteredAlike) {
  EXPECT_GT(list_regions(bumps(), kSurface).regions.size(), 8u);
  expect_same_for_any_threads([] {
    std::ostringstream text;
    text.precision(17);
    const VoxelRegions found = list_regions(bumps(), kSurface);
    text << found.topology.euler << ' ' << found.topology.volume_mm3 << '\n';
    for (const VoxelRegion& r : found.regions) {
      text << r.inside << ' ' << r.samples << ' ' << r.volume_mm3 << ' ' << r.low[0] << ' ' << r.parent << '\n';
    }
    const FilteredVolume filtered = filter_components(bumps(), kSurface, {.min_component_mm3 = 60});
    text << filtered.report.removed_components << ' ' << filtered.report.removed_mm3 << '\n';
    for (float sample : filtered.volume.samples()) text << sample << ' ';
    return text.str();
  });
}

/// Seeds at a wide, a middling and a fine spacing, and landmarks.
std::vector<double> points_of_oracle() {
  const auto oracle = make_isosurface_oracle(bumps(), kSurface);
  std::vector<double> found;
  const auto add = [&](const std::vector<Point3>& points) {
    for (const Point3& p : points) found.insert(found.end(), {p.x, p.y, p.z});
  };
  for (double size : {3.0, 1.4, 0.5}) add(oracle->seeds(size).points);
  const SizeField graded([](const Point3& p) { return 0.6 + 0.02 * p.x; }, 0.6, 2.4);
  add(oracle->seeds(graded).points);
  const Landmarks landmarks = oracle->landmarks(0.5);
  add(landmarks.points);
  for (const auto& link : landmarks.links) found.insert(found.end(), {double(link[0]), double(link[1])});
  return found;
}

TEST(Threads, BricksSeedsAndLandmarksAreTheSame) {
  EXPECT_GT(points_of_oracle().size(), 100000u);
  expect_same_for_any_threads(points_of_oracle);
}

const Mesh& mesh_of_bumps() {
  static const Mesh mesh = by_threads(1, [] {
    DelTetSurfOptions options;
    options.surface.size = 2;
    options.surface.min_ball_radius = 1e-4;
    options.tets.cell_size = 2;
    RunReport report;
    TetMesh made = deltetsurf(*make_isosurface_oracle(bumps(), kSurface), options, report);
    made.info.isovalue = kSurface.isovalue;
    return Mesh(std::move(made));
  });
  return mesh;
}

TEST(Threads, ChecksFindTheSame) {
  ASSERT_GT(std::get<TetMesh>(mesh_of_bumps()).tets.size(), 15000u);
  expect_same_for_any_threads([] {
    CheckOptions options;
    options.volume = &bumps();
    const CheckReport report = check_mesh(mesh_of_bumps(), options);
    EXPECT_EQ(report.find("positive tets")->status, CheckStatus::kPassed);
    std::ostringstream text;
    text.precision(17);
    text << to_text(report);
    for (const Check& check : report.checks) text << check.name << ' ' << check.measured << '\n';
    return text.str();
  });
}

TEST(Threads, WrittenFilesAreTheSame) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("delvox_threads_" + std::to_string(getpid()) + ".vtu");
  expect_same_for_any_threads([&] {
    write_mesh(mesh_of_bumps(), path);
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  });
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace delvox
