#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <string>

#include "delvox/core/errors.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "support/shapes.h"

namespace delvox {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A run that would take minutes if nothing stopped it, but whose seeds are few.
DelTetSurfOptions endless_options() {
  DelTetSurfOptions options;
  options.surface.size = 2;
  options.tets.cell_size = 0.05;
  return options;
}

std::unique_ptr<SmoothOracle> sphere() {
  return test::voxel_phantom_oracle("sphere", test::cubic_image(32));
}

TEST(RunControl, MaxVerticesStopsTheTetsWithWhatThereIs) {
  DelTetSurfOptions options = endless_options();
  options.control.limits.max_vertices = 3000;
  RunReport report;
  const TetMesh mesh = deltetsurf(*sphere(), options, report);
  EXPECT_EQ(report.stop, StopReason::kMaxVertices);
  EXPECT_FALSE(report.succeeded());
  EXPECT_FALSE(mesh.info.complete);
  EXPECT_LE(mesh.points.size(), 3000u);
  EXPECT_GT(mesh.points.size(), 2500u);
  EXPECT_EQ(test::topology_of(boundary_surface(mesh)).open_or_crowded_edges, 0u);
  std::size_t not_positive = 0;
  for (const Tet& tet : mesh.tets) not_positive += !(test::shape_of(mesh, tet).volume > 0);
  EXPECT_EQ(not_positive, 0u);
}

TEST(RunControl, MaxVerticesStopsTheSurfaceToo) {
  DelSurfOptions options;
  options.surface.size = 20;
  options.surface.max_deviation = 1e-3;
  options.control.limits.max_vertices = 400;
  RunReport report;
  const SurfaceMesh mesh = delsurf(*sphere(), options, report);
  EXPECT_EQ(report.stop, StopReason::kMaxVertices);
  EXPECT_FALSE(mesh.info.complete);
  EXPECT_LE(mesh.points.size(), 400u);
  EXPECT_GT(mesh.points.size(), 300u);
}

TEST(RunControl, MaxSecondsStopsWithWhatThereIs) {
  DelTetSurfOptions options = endless_options();
  options.control.limits.max_seconds = 0.3;
  RunReport report;
  const auto start = Clock::now();
  const TetMesh mesh = deltetsurf(*sphere(), options, report);
  EXPECT_LT(seconds_since(start), 20);  // generous: the machine may be busy
  EXPECT_EQ(report.stop, StopReason::kMaxSeconds);
  EXPECT_FALSE(mesh.info.complete);
  EXPECT_FALSE(mesh.tets.empty());
}

TEST(RunControl, ALimitThatIsNotReachedChangesNothing) {
  DelTetSurfOptions options = endless_options();
  options.tets.cell_size = 2;
  RunReport report;
  const TetMesh free = deltetsurf(*sphere(), options, report);
  options.control.limits.max_vertices = 1000000;
  options.control.limits.max_seconds = 1000;
  const TetMesh limited = deltetsurf(*sphere(), options, report);
  EXPECT_EQ(report.stop, StopReason::kFinished);
  EXPECT_EQ(limited.points, free.points);
  EXPECT_EQ(limited.tets, free.tets);
}

TEST(RunControl, CancellingBeforehandThrowsAtOnce) {
  std::atomic<bool> cancel{true};
  DelTetSurfOptions options = endless_options();
  options.control.cancel = &cancel;
  RunReport report;
  const auto oracle = sphere();
  const auto start = Clock::now();
  EXPECT_THROW(deltetsurf(*oracle, options, report), Cancelled);
  EXPECT_LT(seconds_since(start), 5);
}

TEST(RunControl, CancellingUnderWayThrowsSoonAfter) {
  std::atomic<bool> cancel{false};
  Clock::time_point asked;
  DelTetSurfOptions options = endless_options();
  options.control.cancel = &cancel;
  options.control.on_progress = [&](const Progress&) {
    if (cancel.exchange(true)) return;
    asked = Clock::now();
  };
  RunReport report;
  EXPECT_THROW(deltetsurf(*sphere(), options, report), Cancelled);
  EXPECT_TRUE(cancel);
  EXPECT_LT(seconds_since(asked), 5);
}

TEST(RunControl, CancellingWhileSeedsArePlacedThrowsSoonAfter) {
  constexpr std::size_t kAskedBefore = 500;
  std::atomic<bool> cancel{false};
  std::atomic<std::size_t> asked{0};  // by several threads
  DelSurfOptions options;
  options.control.cancel = &cancel;
  const auto size = [&](const Point3&) {
    cancel = ++asked >= kAskedBefore;
    return 0.3;
  };
  options.surface.size = SizeField(size, 0.3, 0.3);
  RunReport report;
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(64));  // over 7000 crossings to ask at
  EXPECT_THROW(delsurf(*oracle, options, report), Cancelled);
  EXPECT_GE(asked, kAskedBefore);
  EXPECT_LT(asked, kAskedBefore + 1500);  // those of some bricks
}

TEST(RunControl, ProgressIsASignOfLifeAFewTimesASecond) {
  std::set<std::string> stages;
  std::size_t calls = 0, last = 0;
  bool grows = true;
  DelTetSurfOptions options = endless_options();
  options.control.limits.max_seconds = 1;
  options.control.on_progress = [&](const Progress& progress) {
    ++calls;
    stages.insert(progress.stage);
    grows &= progress.vertices >= last;
    last = progress.vertices;
  };
  RunReport report;
  const auto start = Clock::now();
  deltetsurf(*sphere(), options, report);
  const double seconds = seconds_since(start);
  EXPECT_GE(calls, 2u);
  EXPECT_LE(static_cast<double>(calls), 10 * seconds + 1);
  EXPECT_TRUE(grows);
  EXPECT_TRUE(stages.count("interior"));
  EXPECT_FALSE(stages.count(""));
}

}  // namespace
}  // namespace delvox
