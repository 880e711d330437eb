#include "delvox/meshing/delsurf2.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/oracle/formula.h"
#include "delvox/oracle/jet.h"
#include "mesh_expectations.h"

namespace delvox {
namespace {

const Box3 kBox{{-3, -3, -3}, {3, 3, 3}};
const char* const kSphere = "x^2+y^2+z^2-1";
const char* const kTorus = "(x^2+y^2+z^2+0.91)^2-4*(x^2+y^2)";

/// No bound but the topology's.
DelSurf2Options topology_only() {
  DelSurf2Options options;
  options.surface.min_angle_degrees = 0;
  return options;
}

SurfaceMesh mesh_of(const std::string& formula, const DelSurf2Options& options, RunReport& report) {
  return delsurf2(*make_smooth_function(Formula(formula)), kBox, options, report);
}

/// A formula, and what its surface is.
struct KnownSurface {
  const char* name;
  const char* formula;
  std::size_t components;
  long euler;
};

const KnownSurface kSurfaces[] = {
    {"Sphere", kSphere, 1, 2},
    {"LongEllipsoid", "x^2/6+8*y^2+8*z^2-1", 1, 2},
    {"FlatEllipsoid", "x^2/4+y^2/4+20*z^2-1", 1, 2},
    {"Torus", kTorus, 1, 0},
    {"ThinTorus", "(x^2+y^2+z^2+3.99)^2-16*(x^2+y^2)", 1, 0},  // radii 2 and 0.1
    {"TorusByRoots", "(sqrt(x^2+y^2)-1)^2+z^2-0.1", 1, 0},
    {"DoubleTorus", "(x^2*(1-x^2)-y^2)^2+0.5*z^2-0.02", 1, -2},
    {"Genus5", "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", 1, -8},
    {"Genus7", "((x^2+y^2-1)^2+z^2-0.05)*((y^2+z^2-1)^2+x^2-0.05)*((z^2+x^2-1)^2+y^2-0.05)-0.01", 1, -12},
    {"TwoBallsApart", "min((x-1)^2+y^2+z^2-0.5,(x+1)^2+y^2+z^2-0.01)", 2, 4},
    {"NearlyTouchingBalls", "((x-1)^2+y^2+z^2-0.98)*((x+1)^2+y^2+z^2-0.98)", 2, 4},
    {"BarelyJoinedBalls", "((x-1)^2+y^2+z^2-0.98)*((x+1)^2+y^2+z^2-0.98)-0.005", 1, 2},
    {"NestedShells", "(x^2+y^2+z^2-0.5)*(x^2+y^2+z^2-1)*(x^2+y^2+z^2-2)", 3, 6},
    {"LinkedRings", "((x^2+y^2+z^2+0.96)^2-4*(x^2+y^2))*(((x-1)^2+y^2+z^2+0.96)^2-4*((x-1)^2+z^2))", 2, 0}};

class DelSurf2On : public testing::TestWithParam<KnownSurface> {};
INSTANTIATE_TEST_SUITE_P(Formulas, DelSurf2On, testing::ValuesIn(kSurfaces),
                         [](const auto& info) { return info.param.name; });

// Theorem 14.7, and section 14.4 for the angles.
TEST_P(DelSurf2On, TheMeshIsHomeomorphicToTheSurface) {
  for (double min_angle : {0.0, 30.0}) {
    DelSurf2Options options;
    options.surface.min_angle_degrees = min_angle;
    RunReport report;
    const SurfaceMesh mesh = mesh_of(GetParam().formula, options, report);
    test::expect_finished(report);
    test::expect_all_checks_hold(mesh);
    EXPECT_TRUE(mesh.info.complete);
    EXPECT_FALSE(mesh.info.promises.size);
    test::expect_closed_manifold(mesh);
    const test::SurfaceTopology found = test::topology_of(mesh);
    EXPECT_EQ(found.components, GetParam().components);
    EXPECT_EQ(found.euler, GetParam().euler);
    const Formula formula(GetParam().formula);
    for (const Point3& p : mesh.points) {
      EXPECT_LE(std::abs(formula.value(p)), 1e-9 * norm(formula.gradient(p)));
    }
  }
}

TEST(DelSurf2, TakesFewVerticesWhereTheTopologyIsSimple) {
  RunReport report;
  EXPECT_LE(mesh_of(kSphere, topology_only(), report).points.size(), 20u);
  EXPECT_LE(mesh_of(kTorus, topology_only(), report).points.size(), 120u);
}

TEST(DelSurf2, MeetsASizeAndADeviationIfAsked) {
  DelSurf2Options options;
  options.surface.size = 0.15;
  RunReport report;
  const SurfaceMesh fine = mesh_of(kSphere, options, report);
  test::expect_finished(report);
  test::expect_good_triangles(fine, 0.15);
  EXPECT_EQ(fine.info.promises.size, 0.15);
  EXPECT_GT(report.surface_insertions, 50u);

  options = {};
  options.surface.max_deviation = 0.01;
  const SurfaceMesh close = mesh_of(kSphere, options, report);
  test::expect_finished(report);
  for (const Triangle& t : close.triangles) {
    const Point3 middle = test::circumcenter(close.points[t[0]], close.points[t[1]], close.points[t[2]]);
    EXPECT_NEAR(norm(middle), 1, 0.01 + 1e-9);
  }
}

TEST(DelSurf2, MeshesCode) {
  const auto torus = make_smooth_function_of([](const auto& x, const auto& y, const auto& z) {
    const auto rr = x * x + y * y;
    return power(rr + z * z + 0.91, 2) - 4.0 * rr;
  });
  RunReport report;
  const SurfaceMesh mesh = delsurf2(*torus, kBox, {}, report);
  test::expect_finished(report);
  test::expect_closed_manifold(mesh);
  EXPECT_EQ(test::topology_of(mesh).euler, 0);
}

/// A function whose second and third derivatives are hardly known.
class Loose final : public SmoothFunction {
 public:
  explicit Loose(const char* formula) : function_(make_smooth_function(Formula(formula))) {}
  void evaluate(const Point3& p, int order, double* results) const override { function_->evaluate(p, order, results); }
  bool enclose(const IntervalBox& box, int order, Interval* results) const override {
    const bool smooth = function_->enclose(box, order, results);
    for (std::size_t i = kResults[1]; i < kResults[order]; ++i) results[i] = {-1e4, 1e4};
    return smooth;
  }

 private:
  std::unique_ptr<SmoothFunction> function_;
};

// Without them no search can tell zeros apart: the sample gets denser until none is needed, or the report says where.
TEST(DelSurf2, WhatCannotBeDecidedIsToldOrRefined) {
  DelSurf2Options options = topology_only();
  options.control.limits.max_vertices = 3000;
  RunReport report;
  const SurfaceMesh mesh = delsurf2(Loose(kTorus), kBox, options, report);
  if (report.succeeded()) {
    test::expect_closed_manifold(mesh);
    EXPECT_EQ(test::topology_of(mesh).euler, 0);
  } else {
    EXPECT_FALSE(mesh.info.complete);
    EXPECT_TRUE(report.stop != StopReason::kFinished || !report.unmet.empty());
  }
}

// On a sphere smaller than the distance to which vertices may approach each other, nothing can be inserted for it.
TEST(DelSurf2, WhatStaysUndecidedBesideAVertexIsToldWithItsPlace) {
  RunReport report;
  const SurfaceMesh mesh = delsurf2(Loose("x^2+y^2+z^2-1e-8"), kBox, topology_only(), report);
  EXPECT_EQ(report.stop, StopReason::kFinished);
  EXPECT_FALSE(report.succeeded());
  EXPECT_FALSE(mesh.info.complete);
  ASSERT_FALSE(report.unmet.empty());
  for (const Unmet& unmet : report.unmet) {
    EXPECT_EQ(unmet.criterion, "topology");
    EXPECT_TRUE(unmet.breaks_promise);
    EXPECT_NE(unmet.reason.find("may"), std::string::npos) << unmet.reason;
    ASSERT_TRUE(unmet.where);
    EXPECT_NEAR(norm(*unmet.where - Point3{}), 1e-4, 2e-5);
  }
}

TEST(DelSurf2, SizesOfAVolumeAreTakenInTheWorld) {
  // Turned by a quarter and mirrored: the domain's own +x is the world's +y.
  SmoothDomain domain{make_smooth_function(Formula(kSphere)), kBox, {}};
  domain.to_world.rows = {{{0, -1, 0, 5}, {1, 0, 0, 0}, {0, 0, -1, 0}}};
  DelSurf2Options options;
  options.surface.size = SizeField([](const Point3& p) { return p.y > 0.3 ? 0.1 : 0.5; }, 0.1, 0.5);
  RunReport report;
  const SurfaceMesh mesh = delsurf2(domain, options, report);
  test::expect_finished(report);
  test::expect_all_checks_hold(mesh);  // facing outward, too
  std::size_t above = 0;
  for (const Point3& p : mesh.points) {
    EXPECT_NEAR(distance(p, {5, 0, 0}), 1, 1e-9);
    above += p.y > 0;
  }
  EXPECT_GT(above, 2 * mesh.points.size() / 3);
}

TEST(DelSurf2, RunsGiveTheSameMesh) {
  RunReport report;
  const SurfaceMesh a = mesh_of(kTorus, {}, report), b = mesh_of(kTorus, {}, report);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(DelSurf2, RefusesKinksOnTheSurfaceAndTheBordersOfTheBox) {
  RunReport report;
  EXPECT_THROW(mesh_of("max(x^2+y^2+z^2-1,x)", {}, report), OptionError);
  EXPECT_THROW(mesh_of("x^2+y^2+z^2-10", {}, report), OptionError);
  EXPECT_THROW(mesh_of("(x^2+y^2+z^2-1)^2", {}, report), OptionError);
}

TEST(DelSurf2, AnEmptySurfaceIsNothingToMesh) {
  RunReport report;
  EXPECT_THROW(mesh_of("x^2+y^2+z^2+1", {}, report), NothingToMesh);
}

TEST(DelSurf2, LimitsEndARunAndAreTold) {
  DelSurf2Options options = topology_only();
  options.control.limits.max_vertices = 30;
  RunReport report;
  const SurfaceMesh mesh = mesh_of(kTorus, options, report);
  EXPECT_EQ(report.stop, StopReason::kMaxVertices);
  EXPECT_FALSE(mesh.info.complete);
  EXPECT_LE(mesh.points.size(), 31u);
}

TEST(DelSurf2, CanBeCancelled) {
  const std::atomic<bool> cancel = true;
  DelSurf2Options options;
  options.control.cancel = &cancel;
  RunReport report;
  EXPECT_THROW(mesh_of(kTorus, options, report), Cancelled);
}

}  // namespace
}  // namespace delvox
