#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delvox/meshing/delsurf.h"
#include "delvox/oracle/polygon_oracle.h"
#include "support/random.h"
#include "support/shapes.h"

// One suite for every oracle: each makes the same bodies, and must give the same answers about them.

namespace delvox {
namespace {

struct Maker {
  const char* name;
  PhantomOptions image;
  std::unique_ptr<Oracle> (*make)(std::string_view kind, const PhantomOptions& image);
  double error;  ///< how far the oracle's surface may be from the shape it stands for, mm
};

constexpr double kResolution = 0.4;

std::unique_ptr<Oracle> make_voxels(std::string_view kind, const PhantomOptions& image) {
  return test::voxel_phantom_oracle(kind, image);
}

std::unique_ptr<Oracle> make_implicit(std::string_view kind, const PhantomOptions& image) {
  return test::implicit_phantom_oracle(kind, image, kResolution);
}

std::unique_ptr<Oracle> make_polygons(std::string_view kind, const PhantomOptions& image) {
  DelSurfOptions options;
  options.surface.size = 1;
  RunReport report;
  return make_polygon_oracle(delsurf(*test::implicit_phantom_oracle(kind, image, kResolution), options, report));
}

class OracleSuite : public testing::TestWithParam<Maker> {
 protected:
  std::unique_ptr<Oracle> make(std::string_view kind) const { return GetParam().make(kind, GetParam().image); }
  PhantomTruth truth(std::string_view kind) const { return phantom_truth(kind, GetParam().image); }
  Point3 center() const { return GetParam().image.center; }
  double error() const { return GetParam().error; }

  /// On the surface to rounding: in value, and in distance; where there is no value, labels change within 1e-9.
  static void expect_on_surface(const Oracle& any, const Point3& p) {
    if (dynamic_cast<const SmoothOracle*>(&any) == nullptr) {
      bool changes = false;
      for (const Vector3& step : {Vector3{1e-9, 0, 0}, {0, 1e-9, 0}, {0, 0, 1e-9}}) {
        changes |= any.label(p - step) != any.label(p + step);
      }
      EXPECT_TRUE(changes);
      return;
    }
    const auto& oracle = dynamic_cast<const SmoothOracle&>(any);
    const double value = std::abs(oracle.value(p));
    EXPECT_LE(value, 1e-9);
    EXPECT_LE(value, 1e-9 * norm(oracle.gradient(p)));
  }
  /// Between a and b, not just on their line.
  static void expect_between(const Point3& p, const Point3& a, const Point3& b) {
    EXPECT_LE(distance(a, p) + distance(p, b), distance(a, b) * (1 + 1e-12) + 1e-12);
  }
};

const Maker kSmooth[] = {{"Voxels", test::cubic_image(32), make_voxels, 0.05},
                         {"ObliqueVoxels", test::oblique_image(), make_voxels, 0.08},
                         {"Formula", test::cubic_image(32), make_implicit, 1e-9},
                         {"FormulaAwayFromOrigin", test::oblique_image(), make_implicit, 1e-9}};
const Maker kPolygons[] = {{"Polygons", test::cubic_image(32), make_polygons, 0.05},
                           {"PolygonsAwayFromOrigin", test::oblique_image(), make_polygons, 0.05}};

std::string name_of(const testing::TestParamInfo<Maker>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Oracles, OracleSuite, testing::ValuesIn(kSmooth), name_of);
INSTANTIATE_TEST_SUITE_P(PolygonOracles, OracleSuite, testing::ValuesIn(kPolygons), name_of);

/// What only oracles with a value can be asked.
class SmoothOracleSuite : public OracleSuite {
 protected:
  std::unique_ptr<SmoothOracle> make(std::string_view kind) const {
    return std::unique_ptr<SmoothOracle>(dynamic_cast<SmoothOracle*>(OracleSuite::make(kind).release()));
  }
};

INSTANTIATE_TEST_SUITE_P(Oracles, SmoothOracleSuite, testing::ValuesIn(kSmooth), name_of);

TEST_P(OracleSuite, LabelsInsideOutsideAndFarAway) {
  const auto oracle = make("sphere");
  const double radius = *truth("sphere").radius;
  test::Random random(1);
  for (int n = 0; n < 2000; ++n) {
    const Vector3 direction = random.direction();
    EXPECT_EQ(oracle->label(center() + (random.unit() * (radius - error())) * direction), 1);
    EXPECT_EQ(oracle->label(center() + (radius + error() + 5 * random.unit()) * direction), 0);
    EXPECT_EQ(oracle->label(center() + (radius * std::pow(10, 1 + 20 * random.unit())) * direction), 0);
  }
}

TEST_P(OracleSuite, BoundsHoldTheSurfaceAndNothingIsInsideBeyondThem) {
  const auto oracle = make("sphere");
  const Box3 bounds = oracle->bounds();
  const double radius = *truth("sphere").radius;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(bounds.min[axis], center()[axis] - radius);
    EXPECT_GT(bounds.max[axis], center()[axis] + radius);
  }
  test::Random random(2);
  Box3 wide = bounds;
  wide.extend(bounds.center() + 2.0 * (bounds.max - bounds.center()));
  wide.extend(bounds.center() + 2.0 * (bounds.min - bounds.center()));
  for (int n = 0; n < 2000; ++n) {
    const Point3 p = random.in(wide);
    if (!bounds.contains(p)) {
      EXPECT_EQ(oracle->label(p), 0);
    }
  }
}

TEST_P(SmoothOracleSuite, LabelIsTheSignOfTheValue) {
  const auto oracle = make("shells");
  test::Random random(3);
  for (int n = 0; n < 5000; ++n) {
    const Point3 p = random.in(oracle->bounds());
    EXPECT_EQ(oracle->label(p) == 1, oracle->value(p) > 0);
  }
}

TEST_P(OracleSuite, IntersectLiesOnTheSurfaceBetweenTheEnds) {
  const auto oracle = make("shells");
  test::Random random(4);
  int tested = 0;
  while (tested < 1000) {
    const Point3 a = random.in(oracle->bounds()), b = random.in(oracle->bounds());
    if (oracle->label(a) == oracle->label(b)) continue;
    ++tested;
    const Point3 p = oracle->intersect(a, b);
    expect_on_surface(*oracle, p);
    expect_between(p, a, b);
  }
}

TEST_P(OracleSuite, IntersectFindsTheSphereAtItsRadius) {
  const auto oracle = make("sphere");
  const double radius = *truth("sphere").radius;
  test::Random random(5);
  for (int n = 0; n < 1000; ++n) {
    const Point3 p = oracle->intersect(center(), center() + (1.5 * radius) * random.direction());
    EXPECT_NEAR(distance(p, center()), radius, error());
  }
}

TEST_P(OracleSuite, IntersectDoesNotDependOnHowFarTheOuterEndIs) {
  const auto oracle = make("sphere");
  const double radius = *truth("sphere").radius;
  test::Random random(6);
  for (int n = 0; n < 200; ++n) {
    const Vector3 direction = random.direction();
    const Point3 inner = center() + (0.3 * radius) * random.direction();
    const Point3 expected = oracle->intersect(inner, inner + (2 * radius) * direction);
    for (double reach : {10.0, 1e3, 1e5}) {
      const Point3 outer = inner + (reach * radius) * direction;
      EXPECT_LT(distance(oracle->intersect(inner, outer), expected), 1e-9) << reach;
      EXPECT_LT(distance(oracle->intersect(outer, inner), expected), 1e-9) << reach;
    }
  }
}

TEST_P(OracleSuite, IntersectIsOneOfTheCrossingsThatIntersectAllFinds) {
  const auto oracle = make("shells");
  test::Random random(7);
  int tested = 0;
  while (tested < 500) {
    const Point3 a = random.in(oracle->bounds()), b = random.in(oracle->bounds());
    if (oracle->label(a) == oracle->label(b)) continue;
    ++tested;
    const auto all = oracle->intersect_all(a, b);
    EXPECT_EQ(all.size() % 2, 1u);
    for (const Point3& one : {oracle->intersect(a, b), oracle->intersect(b, a)}) {
      const bool known = std::any_of(all.begin(), all.end(), [&](const Point3& p) { return distance(p, one) < 1e-8; });
      EXPECT_TRUE(known);
    }
  }
}

TEST_P(OracleSuite, IntersectAllCountsZeroOneTwoFourAndSixCrossings) {
  const auto sphere = make("sphere"), torus = make("torus"), shells = make("shells");
  const double radius = *truth("sphere").radius;
  const Vector3 x{1, 0, 0}, y{0, 1, 0};
  const Vector3 in_plane = (1 / std::sqrt(13.0)) * Vector3{3, 2, 0};  // of the torus, whose axis is (2, -3, 6)
  const auto count = [&](const Oracle& oracle, const Point3& a, const Point3& b) {
    const auto found = oracle.intersect_all(a, b);
    for (const Point3& p : found) {
      expect_on_surface(oracle, p);
      expect_between(p, a, b);
    }
    return found.size();
  };
  const Point3 c = center();
  EXPECT_EQ(count(*sphere, c + (1.2 * radius) * y - 20.0 * x, c + (1.2 * radius) * y + 20.0 * x), 0u);
  EXPECT_EQ(count(*sphere, c - 0.5 * x, c + 0.5 * x), 0u);
  EXPECT_EQ(count(*sphere, c, c + 20.0 * x), 1u);
  EXPECT_EQ(count(*sphere, c - 20.0 * x, c + 20.0 * x), 2u);
  EXPECT_EQ(count(*torus, c - 30.0 * in_plane, c + 30.0 * in_plane), 4u);
  EXPECT_EQ(count(*shells, c - 30.0 * in_plane, c + 30.0 * in_plane), 6u);
  EXPECT_EQ(count(*sphere, c + 100.0 * y - 20.0 * x, c + 100.0 * y + 20.0 * x), 0u);  // misses the bounds
}

TEST_P(OracleSuite, IntersectAllIsInOrderFromTheFirstEndAndReversesWithTheSegment) {
  const auto oracle = make("shells");
  test::Random random(8);
  for (int n = 0; n < 500; ++n) {
    const Point3 a = random.in(oracle->bounds()), b = random.in(oracle->bounds());
    const auto forward = oracle->intersect_all(a, b);
    auto backward = oracle->intersect_all(b, a);
    std::reverse(backward.begin(), backward.end());
    ASSERT_EQ(forward.size(), backward.size());
    for (std::size_t i = 0; i < forward.size(); ++i) {
      EXPECT_LT(distance(forward[i], backward[i]), 1e-7);
      if (i > 0) {
        EXPECT_LT(distance(a, forward[i - 1]), distance(a, forward[i]));
      }
    }
  }
}

TEST_P(OracleSuite, IntersectAllFindsEveryChangeThatDenseSamplingSees) {
  const auto oracle = make("shells");
  constexpr int kSamples = 1500;
  test::Random random(9);
  int crossings = 0;
  for (int n = 0; n < 300; ++n) {
    const Point3 a = random.in(oracle->bounds()), b = random.in(oracle->bounds());
    std::vector<double> changes;  // arc length
    const double step = distance(a, b) / kSamples;
    Label before = oracle->label(a);
    for (int i = 1; i <= kSamples; ++i) {
      const Label after = oracle->label(a + (static_cast<double>(i) / kSamples) * (b - a));
      if (after != before) changes.push_back((i - 0.5) * step);
      before = after;
    }
    // Formulas are promised to be searched at their resolution only: leave grazing lines to the test below.
    bool grazing = false;
    for (std::size_t i = 1; i < changes.size(); ++i) grazing |= changes[i] - changes[i - 1] < kResolution;
    if (grazing) continue;
    const auto found = oracle->intersect_all(a, b);
    // What sampling misses are pairs closer than its step.
    std::size_t next = 0;
    for (double change : changes) {
      while (next < found.size() && distance(a, found[next]) < change - 0.5001 * step) {
        ASSERT_LT(next + 1, found.size());
        ASSERT_LT(distance(found[next], found[next + 1]), step);
        next += 2;
      }
      ASSERT_LT(next, found.size());
      ASSERT_NEAR(distance(a, found[next]), change, 0.5001 * step);
      ++next;
    }
    EXPECT_EQ((found.size() - next) % 2, 0u);
    crossings += static_cast<int>(changes.size());
  }
  EXPECT_GT(crossings, 300);
}

TEST_P(OracleSuite, GrazingLinesHaveAnEvenNumberOfCrossingsOnTheSurface) {
  const auto oracle = make("sphere");
  test::Random random(10);
  for (int n = 0; n < 300; ++n) {
    const Point3 touch = oracle->intersect(center(), center() + 100.0 * random.direction());
    const Vector3 normal = (1 / distance(touch, center())) * (touch - center());
    const Vector3 across = cross(normal, random.direction());
    const Vector3 tangent = (8 / norm(across)) * across;
    for (double depth : {-1e-3, -1e-9, 0.0, 1e-9, 1e-3}) {
      const Point3 p = touch + depth * normal;
      const auto found = oracle->intersect_all(p - tangent, p + tangent);
      EXPECT_EQ(found.size() % 2, 0u);
      for (const Point3& q : found) expect_on_surface(*oracle, q);
    }
  }
}

TEST_P(OracleSuite, SeedsLieOnTheSurfaceAndComeAlikeEachTime) {
  const auto oracle = make("shells");
  for (double spacing : {0.3, 1.0, 4.0, 50.0}) {
    const Seeds seeds = oracle->seeds(spacing);
    for (const Point3& p : seeds.points) expect_on_surface(*oracle, p);
    EXPECT_EQ(oracle->seeds(spacing).points, seeds.points);
  }
}

TEST_P(OracleSuite, EveryComponentHasSeedsThatSpanItHoweverWideTheSpacing) {
  const auto oracle = make("shells");
  const PhantomOptions& image = GetParam().image;
  double half_extent = Box3::kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    half_extent = std::min(half_extent, 0.5 * image.dims[axis] * image.spacing[axis]);
  }
  for (double spacing : {0.5, 5.0, 1000.0}) {
    const Seeds seeds = oracle->seeds(spacing);
    EXPECT_EQ(seeds.components, 3u);
    for (double fraction : {0.8, 0.5, 0.25}) {
      const double radius = fraction * half_extent;
      Box3 box;
      int count = 0;
      for (const Point3& p : seeds.points) {
        if (std::abs(distance(p, center()) - radius) > 0.1 * half_extent) continue;
        ++count;
        box.extend(p);
      }
      EXPECT_GE(count, 4) << fraction << " at spacing " << spacing;
      for (int axis = 0; axis < 3; ++axis) EXPECT_GT(box.max[axis] - box.min[axis], 0.5 * radius);
    }
  }
}

TEST_P(OracleSuite, SeedsAreSpacedAsAskedAndLeaveNoGap) {
  const auto oracle = make("sphere");
  for (double spacing : {0.5, 1.5, 4.0}) {
    const auto points = oracle->seeds(spacing).points;
    double closest = Box3::kInfinity;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) closest = std::min(closest, distance(points[i], points[j]));
    }
    // Candidates keep the spacing before they are moved off the grid lines by up to a quarter of it each.
    EXPECT_GT(closest, 0.25 * spacing) << spacing;
    test::Random random(11);
    double widest = 0;
    for (int n = 0; n < 500; ++n) {
      const Point3 p = oracle->intersect(center(), center() + 100.0 * random.direction());
      double nearest = Box3::kInfinity;
      for (const Point3& seed : points) nearest = std::min(nearest, distance(p, seed));
      widest = std::max(widest, nearest);
    }
    EXPECT_LT(widest, 2 * spacing) << spacing;
  }
}

TEST_P(OracleSuite, SeedsFollowASpacingThatVaries) {
  const auto oracle = make("sphere");
  const Point3 c = center();
  const auto points = oracle->seeds({[&](const Point3& p) { return p.x < c.x ? 3.0 : 1.0; }, 1.0, 3.0}).points;
  const auto sparse = std::count_if(points.begin(), points.end(), [&](const Point3& p) { return p.x < c.x; });
  const double ratio = static_cast<double>(points.size() - sparse) / static_cast<double>(sparse);
  EXPECT_GT(ratio, 5);
  EXPECT_LT(ratio, 13);
}

TEST_P(OracleSuite, ACloneGivesTheSameAnswersAndOutlivesItsOriginal) {
  auto oracle = make("shells");
  const auto reference = make("shells");
  const auto clone = oracle->clone();
  oracle.reset();
  test::Random random(12);
  EXPECT_EQ(clone->bounds().min, reference->bounds().min);
  EXPECT_EQ(clone->bounds().max, reference->bounds().max);
  for (int n = 0; n < 1000; ++n) {
    const Point3 a = random.in(reference->bounds()), b = random.in(reference->bounds());
    ASSERT_EQ(clone->label(a), reference->label(a));
    EXPECT_EQ(clone->intersect_all(a, b), reference->intersect_all(a, b));
    if (reference->label(a) != reference->label(b)) {
      EXPECT_EQ(clone->intersect(a, b), reference->intersect(a, b));
    }
  }
  EXPECT_EQ(clone->seeds(2.0).points, reference->seeds(2.0).points);
}

TEST_P(SmoothOracleSuite, GradientIsTheDerivativeOfTheValueNearTheSurface) {
  const auto oracle = make("sphere");
  test::Random random(13);
  int agreeing = 0;
  constexpr int kTrials = 500;
  for (int n = 0; n < kTrials; ++n) {
    const Point3 p = oracle->intersect(center(), center() + 100.0 * random.direction());
    const Vector3 gradient = oracle->gradient(p);
    bool agrees = true;
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-5;
      Point3 ahead = p, behind = p;
      ahead[axis] += kStep;
      behind[axis] -= kStep;
      agrees &= std::abs((oracle->value(ahead) - oracle->value(behind)) / (2 * kStep) - gradient[axis]) < 1e-4;
    }
    agreeing += agrees;
    EXPECT_NEAR(norm(gradient), 1, 0.1);  // the phantom is a signed distance
    EXPECT_LT(dot(gradient, p - center()), 0);
  }
  EXPECT_GE(agreeing, kTrials - 5);  // differences across a voxel face agree with neither side
}

}  // namespace
}  // namespace delvox
