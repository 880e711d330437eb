#include "oracle/samples_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "delvox/core/mesh.h"
#include "support/test_samples.h"

namespace delvox {
namespace {

void expect_passage_of_adjoining_stretches(const SampleTriangulation& t, const Point3& a, const Point3& b) {
  const auto passage = t.passage(a, b);
  EXPECT_EQ(passage.starts_inside, t.finite(t.locate(a)));
  EXPECT_EQ(passage.ends_inside, t.finite(t.locate(b)));
  if (passage.starts_inside || passage.ends_inside) {
    ASSERT_FALSE(passage.stretches.empty());
  }
  for (std::size_t i = 0; i < passage.stretches.size(); ++i) {
    const auto& s = passage.stretches[i];
    EXPECT_TRUE(t.finite(s.cell));
    EXPECT_LE(s.from, s.to);
    if (i > 0) {
      EXPECT_EQ(s.from, passage.stretches[i - 1].to);
    }
    // Its middle lies in the cell, to rounding.
    const Point3 middle = a + (0.5 * (s.from + s.to)) * (b - a);
    for (int f = 0; f < 4; ++f) {
      const Point3& p = t.corner(s.cell, kTetFaces[f][0]);
      const Vector3 normal = cross(t.corner(s.cell, kTetFaces[f][1]) - p, t.corner(s.cell, kTetFaces[f][2]) - p);
      EXPECT_LE(dot(normal, middle - p), 1e-9 * norm(normal));
    }
  }
  if (passage.starts_inside) {
    EXPECT_EQ(passage.stretches.front().from, 0);
  }
  if (passage.ends_inside) {
    EXPECT_EQ(passage.stretches.back().to, 1);
  }
}

TEST(SamplesTriangulation, SegmentsPassFromTetToTetWhateverTheyMeet) {
  for (const double jitter : {0.0, 1e-12, 0.3}) {
    const Samples samples = test::lattice_of_places(6, jitter, 1);
    const SampleTriangulation t(samples.points);
    test::Random random(2);
    const auto anywhere = [&] { return random.in(Box3{{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}}); };
    const auto sample = [&] { return samples.points[static_cast<std::size_t>(random.below(216))]; };
    for (int n = 0; n < 500; ++n) {
      const Point3 a = sample(), b = sample();
      expect_passage_of_adjoining_stretches(t, anywhere(), anywhere());
      expect_passage_of_adjoining_stretches(t, a, anywhere());
      expect_passage_of_adjoining_stretches(t, anywhere(), b);
      expect_passage_of_adjoining_stretches(t, a, b);
      expect_passage_of_adjoining_stretches(t, a, a);
      expect_passage_of_adjoining_stretches(t, b + 2.0 * (b - a), a);  // from beyond, through a sample
    }
  }
}

TEST(SamplesTriangulation, ASegmentThroughTheHullIsAsLongInItAsTheHull) {
  const SampleTriangulation t(test::cube_of_places(300, 3).points);
  test::Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const Point3 a = 3.0 * random.direction(), b = 3.0 * random.direction();
    // The cube's slabs give the exact share.
    double from = 0, to = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double s = (-1 - a[axis]) / (b[axis] - a[axis]), e = (1 - a[axis]) / (b[axis] - a[axis]);
      from = std::max(from, std::min(s, e));
      to = std::min(to, std::max(s, e));
    }
    const auto passage = t.passage(a, b);
    if (from >= to) {
      EXPECT_TRUE(passage.stretches.empty());
    } else {
      ASSERT_FALSE(passage.stretches.empty());
      EXPECT_NEAR(passage.stretches.front().from, from, 1e-12);
      EXPECT_NEAR(passage.stretches.back().to, to, 1e-12);
    }
  }
}

}  // namespace
}  // namespace delvox
