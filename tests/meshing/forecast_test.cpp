#include "delvox/meshing/forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "delvox/meshing/graded_size.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "meshing/size_integrals.h"
#include "phantom_cases.h"

namespace delvox {
namespace {

using test::PhantomCase;

std::unique_ptr<SmoothOracle> oracle_of(const PhantomCase& c) {
  return make_isosurface_oracle(c.volume(), c.isosurface());
}

SurfaceCriteria surface_of(double size) {
  SurfaceCriteria criteria;
  criteria.size = size;
  return criteria;
}

Forecast forecast_of(const Oracle& oracle, double size, const SizeField& cell_size) {
  return forecast_tets(oracle, surface_of(size), {2, cell_size});
}

SizeField varying(double size) {
  return SizeField([size](const Point3&) { return size; }, size, size);
}

class ForecastOnPhantoms : public testing::TestWithParam<PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(Phantoms, ForecastOnPhantoms,
                         testing::Values(PhantomCase{"sphere", test::cubic_image(48), 1},
                                         PhantomCase{"ellipsoid", test::cubic_image(48), 2},
                                         PhantomCase{"torus", test::cubic_image(48), 1.2},
                                         PhantomCase{"shells", test::cubic_image(48), 1.5},
                                         PhantomCase{"gyroid", test::cubic_image(32), 0.8},
                                         PhantomCase{"oblique-sphere", test::oblique_image(), 1.5},
                                         PhantomCase{"border", test::cubic_image(32), 1.5}),
                         [](const auto& info) { return test::test_name(info.param); });

TEST_P(ForecastOnPhantoms, IsWithinAQuarterOfTheMeshes) {
  const PhantomCase& c = GetParam();
  const auto oracle = oracle_of(c);
  RunReport report;
  const SurfaceCriteria surface = surface_of(c.size);
  for (const double cell_size : {c.size, 2 * c.size}) {
    const TetMesh mesh = deltetsurf(*oracle, {surface, {2, cell_size}, {}}, report);
    const Forecast forecast = forecast_of(*oracle, c.size, cell_size);
    EXPECT_FALSE(forecast.thin());
    const double tolerance = cell_size == c.size ? 0.25 : 0.4;  // how tets grow with depth is known less well
    EXPECT_NEAR(forecast.likely.vertices / static_cast<double>(mesh.points.size()), 1, tolerance) << cell_size;
    EXPECT_NEAR(forecast.likely.tets / static_cast<double>(mesh.tets.size()), 1, tolerance) << cell_size;
    EXPECT_NEAR(forecast.likely.triangles / static_cast<double>(mesh.boundary.size()), 1, tolerance) << cell_size;
  }
  const SurfaceMesh mesh = delsurf(*oracle, {surface, {}}, report);
  const Forecast forecast = forecast_surface(*oracle, surface);
  EXPECT_NEAR(forecast.likely.vertices / static_cast<double>(mesh.points.size()), 1, 0.25);
  EXPECT_NEAR(forecast.likely.triangles / static_cast<double>(mesh.triangles.size()), 1, 0.25);
  EXPECT_EQ(forecast.likely.tets, 0);
  EXPECT_GT(forecast.likely.bytes, 0);
  EXPECT_GT(forecast.likely.seconds, 0);
}

TEST_P(ForecastOnPhantoms, KnowsTetsThatGrowWithDepth) {
  const PhantomCase& c = GetParam();
  const auto oracle = oracle_of(c);
  RunReport report;
  const SurfaceCriteria surface = surface_of(c.size);
  const DepthField depth(*oracle, c.size);
  for (const double grade : {0.1, 0.5}) {
    const TetCriteria tets = graded({2, Box3::kInfinity}, c.size, depth, grade);
    const TetMesh mesh = deltetsurf(*oracle, {surface, tets, {}}, report);
    const Forecast forecast = forecast_tets(*oracle, surface, tets);
    EXPECT_NEAR(forecast.likely.vertices / static_cast<double>(mesh.points.size()), 1, 0.5) << grade;
    EXPECT_NEAR(forecast.likely.tets / static_cast<double>(mesh.tets.size()), 1, 0.7) << grade;
  }
}

TEST(Forecast, GrowsWithTheCubeOfFinenessInsideAndItsSquareOnTheSurface) {
  const auto oracle = oracle_of({"sphere", test::cubic_image(48), 1});
  const Forecast coarse = forecast_of(*oracle, 0.2, 0.2), fine = forecast_of(*oracle, 0.1, 0.1);
  EXPECT_NEAR(fine.likely.tets / coarse.likely.tets, 8, 0.2);
  EXPECT_GT(fine.likely.bytes, 4 * coarse.likely.bytes);
  const Forecast less = forecast_surface(*oracle, surface_of(0.2)), more = forecast_surface(*oracle, surface_of(0.1));
  EXPECT_NEAR(more.likely.triangles / less.likely.triangles, 4, 1e-6);
}

// Where the cell size varies, there is no lattice, and refinement needs some more tets.
TEST(Forecast, FollowsASizeField) {
  const PhantomCase c{"sphere", test::cubic_image(48), 1};
  const auto oracle = oracle_of(c);
  RunReport report;
  const SizeField size([](const Point3& p) { return p.x < 0 ? 1.0 : 2.0; }, 1, 2);
  SurfaceCriteria surface;
  surface.size = size;
  const TetMesh mesh = deltetsurf(*oracle, {surface, {2, size}, {}}, report);
  const Forecast forecast = forecast_tets(*oracle, surface, {2, size});
  EXPECT_NEAR(forecast.likely.tets / static_cast<double>(mesh.tets.size()), 1, 0.25);
  EXPECT_GT(forecast_of(*oracle, 1, varying(1)).likely.tets, forecast_of(*oracle, 1, 1).likely.tets);
}

TEST(Forecast, TellsThatPartsAreThinnerThanTheSize) {
  const PhantomCase c{"plate", test::cubic_image(64), 1};
  const auto oracle = oracle_of(c);
  EXPECT_FALSE(forecast_of(*oracle, 0.5, 0.5).thin());
  const Forecast thin = forecast_of(*oracle, 10, 10);
  EXPECT_TRUE(thin.thin());
  EXPECT_GT(thin.likely.vertices, 3 * thin.least.vertices);
  // Resolving a plate takes triangles as wide as it is thick, whatever larger size is asked for.
  const Forecast thinner = forecast_of(*oracle, 20, 20);
  EXPECT_NEAR(thinner.likely.vertices / thin.likely.vertices, 1, 0.3);
  EXPECT_LT(thinner.least.vertices, 0.5 * thin.least.vertices);
}

TEST(Forecast, OneSheetOfSurfaceIsNotThinHoweverItLies) {
  for (const char* kind : {"sphere", "ellipsoid", "ramp", "oblique-sphere"}) {
    const PhantomCase c{kind, phantom_defaults(kind), 1};
    const auto oracle = oracle_of(c);
    const SizeField size = 4;
    const TetCriteria tets{2, size};
    const MeasuredDomain measured = measure_domain(*oracle, size, &tets);
    EXPECT_NEAR(measured.resolved.surface / measured.wanted.surface, 1, 0.1) << kind;
    EXPECT_NEAR(measured.resolved.volume / measured.wanted.volume, 1, 0.1) << kind;
  }
}

TEST(Forecast, IsZeroForADomainThatCannotTell) {
  class Unknown final : public Oracle {
    Box3 bounds() const override { return {}; }
    Label label(const Point3&) const override { return 0; }
    Point3 intersect(const Point3& a, const Point3&) const override { return a; }
    std::vector<Point3> intersect_all(const Point3&, const Point3&) const override { return {}; }
    Seeds seeds(const SizeField&, const GoOn&) const override { return {}; }
    std::unique_ptr<Oracle> clone() const override { return std::make_unique<Unknown>(); }
  };
  const Forecast forecast = forecast_of(Unknown(), 1, 1);
  EXPECT_EQ(forecast.likely.vertices, 0);
  EXPECT_EQ(forecast.likely.bytes, 0);
  EXPECT_FALSE(forecast.thin());
}

}  // namespace
}  // namespace delvox
