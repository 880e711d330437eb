#include "meshing/check_options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "delvox/core/errors.h"
#include "delvox/meshing/delsurf.h"
#include "delvox/meshing/deltetsurf.h"
#include "support/shapes.h"

namespace delvox {
namespace {

const double kNan = std::nan("");

std::vector<std::function<void(SurfaceCriteria&)>> bad_surface_criteria() {
  std::vector<std::function<void(SurfaceCriteria&)>> bad;
  for (double value : {0.0, -1.0, kNan}) {
    bad.push_back([=](SurfaceCriteria& c) { c.size = value; });
    bad.push_back([=](SurfaceCriteria& c) { c.max_deviation = value; });
    bad.push_back([=](SurfaceCriteria& c) { c.size = SizeField([](const Point3&) { return 1.0; }, value, 2.0); });
  }
  for (double value : {31.0, 30.001, -0.001, kNan}) {
    bad.push_back([=](SurfaceCriteria& c) { c.min_angle_degrees = value; });
  }
  for (double value : {-0.1, kNan}) {
    bad.push_back([=](SurfaceCriteria& c) { c.min_ball_radius = value; });
    bad.push_back([=](SurfaceCriteria& c) { c.thin_ball_radius = value; });
    bad.push_back([=](SurfaceCriteria& c) { c.min_smooth_radius = value; });
  }
  for (double value : {0.0, -5.0, 180.5, kNan}) {
    bad.push_back([=](SurfaceCriteria& c) { c.max_roughness_degrees = value; });
  }
  return bad;
}

TEST(CheckOptions, SurfaceCriteriaUnderWhichRefinementNeedNotEndAreRefused) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(12));
  const auto bad = bad_surface_criteria();
  for (std::size_t i = 0; i < bad.size(); ++i) {
    DelSurfOptions options;
    DelTetSurfOptions tet_options;
    bad[i](options.surface);
    bad[i](tet_options.surface);
    RunReport report;
    EXPECT_THROW(delsurf(*oracle, options, report), OptionError) << i;
    EXPECT_THROW(deltetsurf(*oracle, tet_options, report), OptionError) << i;
  }
}

TEST(CheckOptions, FoldsAreBoundFromNoughtToNinetyDegrees) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(12));
  for (double degrees : {-1.0, 90.1, kNan}) {
    DelTetSurfOptions options;
    options.min_fold_degrees = degrees;
    RunReport report;
    EXPECT_THROW(deltetsurf(*oracle, options, report), OptionError) << degrees;
  }
}

TEST(CheckOptions, TetCriteriaUnderWhichRefinementNeedNotEndAreRefused) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(12));
  std::vector<std::function<void(TetCriteria&)>> bad;
  for (double value : {1.9, 1.999999, 0.0, -2.0, kNan}) bad.push_back([=](TetCriteria& c) { c.radius_edge = value; });
  for (double value : {0.0, -1.0, kNan}) bad.push_back([=](TetCriteria& c) { c.cell_size = value; });
  for (double value : {-0.1, kNan}) bad.push_back([=](TetCriteria& c) { c.grade = value; });
  for (std::size_t i = 0; i < bad.size(); ++i) {
    DelTetSurfOptions options;
    bad[i](options.tets);
    RunReport report;
    EXPECT_THROW(deltetsurf(*oracle, options, report), OptionError) << i;
  }
}

TEST(CheckOptions, ErrorsAreOneLineThatNamesTheValueAndTheMend) {
  try {
    TetCriteria criteria;
    criteria.radius_edge = 1.9;
    check_criteria(criteria);
    FAIL();
  } catch (const OptionError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("1.9"), std::string::npos);
    EXPECT_NE(message.find("at least 2"), std::string::npos);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(CheckOptions, TheLimitsThemselvesAreAllowed) {
  SurfaceCriteria surface;
  for (double angle : {0.0, 30.0}) {
    surface.min_angle_degrees = angle;
    EXPECT_NO_THROW(check_criteria(surface));
  }
  TetCriteria tets;
  tets.radius_edge = 2;
  EXPECT_NO_THROW(check_criteria(tets));
}

TEST(CheckOptions, PromisesAreTheCriteria) {
  SurfaceCriteria surface;
  surface.size = SizeField([](const Point3& p) { return p.x < 0 ? 1.0 : 2.0; }, 1, 2);
  surface.min_angle_degrees = 25;
  EXPECT_EQ(promises_of(surface).size, 2.0);
  EXPECT_EQ(promises_of(surface).min_angle_degrees, 25.0);
  EXPECT_FALSE(promises_of(surface).max_deviation);
  EXPECT_FALSE(promises_of(surface).radius_edge);
  surface.max_deviation = 0.1;
  TetCriteria tets;
  tets.cell_size = 3;
  EXPECT_EQ(promises_of(surface, tets).max_deviation, 0.1);
  EXPECT_EQ(promises_of(surface, tets).radius_edge, 2.0);
  EXPECT_EQ(promises_of(surface, tets).cell_size, 3.0);
}

TEST(Promises, OfTheDeviationAreWithdrawnWhereTrianglesWereLeftBeyondIt) {
  SurfaceCriteria criteria;
  criteria.max_deviation = 0.1;
  Promises promises = promises_of(criteria);
  RunReport report;
  withdraw_unmet(report, promises);
  EXPECT_EQ(promises.max_deviation, 0.1);
  report.unmet.push_back({"deviation", 3, {}, "", false});
  withdraw_unmet(report, promises);
  EXPECT_FALSE(promises.max_deviation.has_value());
}

}  // namespace
}  // namespace delvox
