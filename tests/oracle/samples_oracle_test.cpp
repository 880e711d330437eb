#include "delvox/oracle/samples_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "delvox/core/errors.h"
#include "delvox/core/merge_points.h"
#include "support/surface_measures.h"
#include "support/test_samples.h"

namespace delvox {
namespace {

constexpr Isosurface kZero{0, false};

std::size_t changes_of_label(const Oracle& oracle, const Point3& a, const Point3& b, int steps) {
  std::size_t changes = 0;
  Label before = oracle.label(a);
  for (int i = 1; i <= steps; ++i) {
    const Label after = oracle.label(a + (double(i) / steps) * (b - a));
    changes += after != before;
    before = after;
  }
  return changes;
}

void expect_at_change(const Oracle& oracle, const Point3& p, double reach) {
  bool changes = false;
  for (const Vector3& step : {Vector3{reach, 0, 0}, {0, reach, 0}, {0, 0, reach}}) {
    changes |= oracle.label(p - step) != oracle.label(p + step);
  }
  EXPECT_TRUE(changes) << p.x << " " << p.y << " " << p.z;
}

/// Noise: every other tet is cut.
Samples noise(Samples places) {
  test::Random random(8);
  for (double& value : places.values) value = random.between(-1, 1);
  return places;
}

TEST(SamplesOracle, EveryCrossingOfASegmentIsFound) {
  for (Interpolation how : {Interpolation::kLinear, Interpolation::kNatural}) {
    const auto oracle = make_samples_oracle(SampleField(noise(test::cube_of_places(60, 9))), kZero, how);
    test::Random random(10);
    const Box3 around{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}};
    std::size_t all = 0, all_seen = 0;
    for (int n = 0; n < (how == Interpolation::kLinear ? 300 : 30); ++n) {
      const Point3 a = random.in(around), b = random.in(around);
      const std::vector<Point3> found = oracle->intersect_all(a, b);
      // Two crossings may lie between two samples of the line.
      const std::size_t seen = changes_of_label(*oracle, a, b, 5000);
      if (how == Interpolation::kLinear) {
        EXPECT_GE(found.size(), seen);
      }
      EXPECT_EQ(found.size() % 2, seen % 2);
      all += found.size();
      all_seen += seen;
      for (const Point3& p : found) expect_at_change(*oracle, p, 1e-7);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end(),
                                 [&](const Point3& p, const Point3& q) { return distance(a, p) < distance(a, q); }));
      if (oracle->label(a) != oracle->label(b)) {
        EXPECT_EQ(found.size() % 2, 1u);
        const Point3 p = oracle->intersect(a, b);
        expect_at_change(*oracle, p, 1e-7);
      } else {
        EXPECT_EQ(found.size() % 2, 0u);
      }
    }
    EXPECT_GT(all, how == Interpolation::kLinear ? 500u : 40u);
    EXPECT_GE(static_cast<double>(all), 0.9 * static_cast<double>(all_seen));
  }
}

// Along edges and faces of tets, through samples, and in the planes of the hull's faces.
TEST(SamplesOracle, SegmentsThroughSamplesAndAlongEdgesAreWalkedToTheirEnds) {
  const SampleField field(noise(test::lattice_of_places(5, 0, 11)));
  const auto oracle = make_samples_oracle(field, kZero);
  test::Random random(12);
  const auto on_lattice = [&] {  // also beyond the hull
    return Point3{0.25 * (random.below(13) - 6), 0.25 * (random.below(13) - 6), 0.25 * (random.below(13) - 6)};
  };
  int bipolar = 0;
  for (int n = 0; n < 3000; ++n) {
    const Point3 a = on_lattice(), b = on_lattice();
    const std::vector<Point3> found = oracle->intersect_all(a, b);
    for (const Point3& p : found) EXPECT_LE(distance(a, p) + distance(p, b), distance(a, b) + 1e-12);
    if (oracle->label(a) == oracle->label(b)) continue;
    ++bipolar;
    const Point3 p = oracle->intersect(a, b);
    const double value = field.value(p);
    const double out = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 1;
    EXPECT_TRUE(std::abs(value) < 1e-9 || std::abs(out) < 1e-12) << value << " " << out;
  }
  EXPECT_GT(bipolar, 500);
}

TEST(SamplesOracle, APlaneThroughTheHullHasTheExactVolumeAndTopology) {
  // x + y/3 >= 0.2 in the cube: its share of the cube by the mean of the cut along y.
  const auto f = [](const Point3& p) { return p.x + p.y / 3 - 0.2; };
  const SampleField field(test::with_values(test::cube_of_places(1000, 13), f));
  EXPECT_NEAR(field.hull_mm3(), 8, 1e-12);
  const SampleField::Inside inside = field.inside(kZero);
  EXPECT_NEAR(inside.mm3, 4 * 0.8, 1e-12);
  EXPECT_NEAR(inside.box.min.x, 0.2 - 1.0 / 3, 1e-12);
  const SurfaceMesh surface = samples_isosurface(field, kZero);
  EXPECT_NEAR(test::enclosed_volume(surface), 4 * 0.8, 1e-12);
  test::expect_closed_manifold(surface);
  const auto oracle = make_samples_oracle(field, kZero);
  EXPECT_EQ(oracle->topology(), (SurfaceTopology{1, 2}));
  double mm3 = 0;
  oracle->for_each_patch([&](const DomainPatch& patch) { mm3 += patch.inside_mm3; });
  EXPECT_NEAR(mm3, 4 * 0.8, 1e-12);
  const auto below = make_samples_oracle(field, {0, true});
  test::Random random(14);
  for (int n = 0; n < 1000; ++n) {
    const Point3 p = random.in(Box3{{-1, -1, -1}, {1, 1, 1}});
    if (std::abs(f(p)) < 1e-9) continue;
    EXPECT_EQ(oracle->label(p), f(p) > 0 ? 1 : 0);
    EXPECT_EQ(below->label(p), f(p) > 0 ? 0 : 1);
  }
}

TEST(SamplesOracle, KnowsTheTopologyOfTheInterpolant) {
  struct Case {
    test::Function f;
    SurfaceTopology topology;
  };
  const auto shell = [](const Point3& p) { return 0.2 - std::abs(norm(p) - 0.6); };
  for (const Case& c : {Case{test::ball, {1, 2}}, {test::torus, {1, 0}}, {shell, {2, 4}}}) {
    const SampleField field(test::with_values(test::lattice_of_places(24, 0.3, 15), c.f));
    EXPECT_EQ(make_samples_oracle(field, kZero)->topology(), c.topology);
    const SurfaceMesh surface = samples_isosurface(field, kZero);
    const test::SurfaceTopology counted = test::topology_of(surface);
    EXPECT_EQ(counted.components, c.topology.components);
    EXPECT_EQ(counted.euler, c.topology.euler);
    EXPECT_EQ(counted.open_or_crowded_edges + counted.singular_vertices, 0u);
  }
  const SampleField noisy(noise(test::cube_of_places(2000, 16)));
  const test::SurfaceTopology counted = test::topology_of(samples_isosurface(noisy, kZero));
  EXPECT_EQ(counted.open_or_crowded_edges + counted.singular_vertices, 0u);
  EXPECT_EQ(make_samples_oracle(noisy, kZero)->topology(), (SurfaceTopology{counted.components, counted.euler}));
}

TEST(SamplesOracle, SeedsLieOnTheSurfaceApartAndOnEveryComponent) {
  const auto balls = [](const Point3& p) {
    return std::max(0.35 - norm(p - Point3{0.4, 0.4, 0.4}), 0.15 - norm(p + Point3{0.5, 0.5, 0.5}));
  };
  const Samples samples = test::with_values(test::lattice_of_places(20, 0.3, 17), balls);
  for (Interpolation how : {Interpolation::kLinear, Interpolation::kNatural}) {
    const auto oracle = make_samples_oracle(SampleField(samples), kZero, how);
    const Seeds seeds = oracle->seeds(0.08);
    EXPECT_EQ(seeds.components, 2u);
    EXPECT_EQ(seeds.component_of.size(), seeds.points.size());
    EXPECT_GT(seeds.points.size(), 150u);
    for (std::uint32_t c : {0u, 1u}) EXPECT_GT(std::count(seeds.component_of.begin(), seeds.component_of.end(), c), 10);
    for (const Point3& p : seeds.points) expect_at_change(*oracle, p, 1e-7);
  }
}

TEST(SamplesOracle, SamplesThatEqualTheIsovalueAreInside) {
  Samples samples = test::lattice_of_places(9, 0.2, 18);
  for (std::size_t i = 0; i < samples.points.size(); ++i) samples.values[i] = norm(samples.points[i]) < 0.6 ? 3 : 1;
  for (const bool below : {false, true}) {
    const SampleField field(samples);
    const auto oracle = make_samples_oracle(field, {below ? 1.0 : 3.0, below});
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      EXPECT_EQ(oracle->label(samples.points[i]), (samples.values[i] == 3) != below ? 1 : 0);
    }
    test::expect_closed_manifold(samples_isosurface(field, {below ? 1.0 : 3.0, below}));
  }
  // A plateau alone: the whole hull.
  for (double& value : samples.values) value = 3;
  const SampleField flat(samples);
  EXPECT_NEAR(flat.inside({3, false}).mm3, flat.hull_mm3(), 1e-12);
  EXPECT_THROW(make_samples_oracle(flat, {3.5, false}), NothingToMesh);
}

}  // namespace
}  // namespace delvox
