#include "delvox/meshing/graded_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/meshing/deltetsurf.h"
#include "mesh_expectations.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

struct Ball {
  std::string kind;
  PhantomOptions image;
  std::unique_ptr<SmoothOracle> oracle = test::voxel_phantom_oracle(kind, image);
  PhantomTruth truth = phantom_truth(kind, image);

  double depth(const Point3& p) const { return *truth.radius - distance(p, *truth.center); }
};

PhantomOptions with_spacing(PhantomOptions options, const Vector3& spacing) {
  options.spacing = spacing;
  return options;
}

const std::vector<std::pair<std::string, PhantomOptions>> kBalls{
    {"sphere", test::cubic_image(48)},
    {"sphere", with_spacing(test::cubic_image(48), {1, 0.7, 2})},
    {"oblique-sphere", test::oblique_image()}};

class GradedSize : public testing::TestWithParam<std::size_t> {
 protected:
  TetMesh mesh_with(double size, double grade, double largest = Box3::kInfinity) {
    DelTetSurfOptions options;
    options.surface.size = size;
    options.tets = graded({2, largest}, size, DepthField(*ball_.oracle, size), grade);
    RunReport report;
    TetMesh mesh = deltetsurf(*ball_.oracle, options, report);
    test::expect_finished(report);
    test::expect_all_checks_hold(mesh);
    test::expect_good_tets(mesh, options.tets.cell_size.maximum());
    return mesh;
  }

  const Ball ball_{kBalls[GetParam()].first, kBalls[GetParam()].second};
};

INSTANTIATE_TEST_SUITE_P(Balls, GradedSize, testing::Range(std::size_t{0}, kBalls.size()));

TEST_P(GradedSize, DepthsAreKnownToASizeAndAThird) {
  test::Random random(7);
  for (const double size : {1.0, 3.0}) {
    const DepthField depth(*ball_.oracle, size);
    const double radius = *ball_.truth.radius;
    double deepest = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vector3 v{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      if (norm(v) >= 1) continue;
      const Point3 p = *ball_.truth.center + radius * v;
      const double known = depth(p), truth = ball_.depth(p);
      ASSERT_LE(known, truth + 0.8 * size) << truth;
      ASSERT_GE(known, truth * 2 / 3 - size) << truth;
      deepest = std::max(deepest, known);
    }
    EXPECT_LE(deepest, depth.maximum());
    EXPECT_LE(depth.maximum(), radius + 0.8 * size);
    EXPECT_EQ(depth(*ball_.truth.center + Vector3{1000, 0, 0}), 0);
  }
}

TEST_P(GradedSize, CircumradiiGrowWithDepthAsFarAsTheGradeAllows) {
  constexpr double kSize = 1.2;
  std::size_t before = mesh_with(kSize, 0).tets.size();
  const double ungraded = static_cast<double>(before);
  for (const double grade : {0.1, 0.3, 1.0}) {
    const TetMesh mesh = mesh_with(kSize, grade);
    EXPECT_LT(mesh.tets.size(), before) << grade;
    before = mesh.tets.size();
    double largest = 0, worst = 0;
    for (const Tet& tet : mesh.tets) {
      const test::TetShape shape = test::shape_of(mesh, tet);
      const double bound = kSize + grade * (ball_.depth(shape.circumcenter) + 0.6 * kSize);
      worst = std::max(worst, shape.circumradius / bound);
      largest = std::max(largest, shape.circumradius);
    }
    EXPECT_LE(worst, 1) << grade;
    EXPECT_GT(largest, kSize * (1 + grade)) << grade;  // and the inside is not refined to the surface's size
    EXPECT_EQ(mesh.info.promises.grade, grade);
  }
  EXPECT_LT(static_cast<double>(before), 0.4 * ungraded);
}

TEST_P(GradedSize, TheLargestCellSizeHoldsToo) {
  const TetMesh growing = mesh_with(1.2, 0.5), held = mesh_with(1.2, 0.5, 2);
  EXPECT_GT(held.tets.size(), growing.tets.size());
  EXPECT_EQ(held.info.promises.cell_size, 2);
}

TEST_P(GradedSize, TheSameInputGivesTheSameMesh) {
  EXPECT_EQ(mesh_with(1.5, 0.3).points, mesh_with(1.5, 0.3).points);
}

// A plate is nowhere deep, however large the box around it is.
TEST(DepthField, FollowsTheNearestOfSeveralSheets) {
  const PhantomOptions image = test::cubic_image(48);
  const auto oracle = test::voxel_phantom_oracle("shells", image);
  const PhantomTruth truth = phantom_truth("shells", image);
  const DepthField depth(*oracle, 1.0);
  test::Random random(3);
  std::size_t inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point3 p{random.between(-24, 24), random.between(-24, 24), random.between(-24, 24)};
    if (oracle->label(p) == 0) continue;
    ++inside;
    ASSERT_NEAR(depth(p), truth.value(p) - truth.isovalue, 1.0 + 0.1 * depth(p));
  }
  EXPECT_GT(inside, 1000u);
}

TEST(DepthField, VaryingSizesAndOraclesWithoutSurfaceAreNoExceptions) {
  const auto oracle = test::voxel_phantom_oracle("sphere", test::cubic_image(48));
  const double radius = *phantom_truth("sphere", test::cubic_image(48)).radius;
  const SizeField size([](const Point3& p) { return p.x < 0 ? 1.0 : 2.0; }, 1, 2);
  const DepthField depth(*oracle, size);
  for (double x = -radius + 0.1; x < radius; x += 0.5) {
    EXPECT_NEAR(depth({x, 0.3, 0}), radius - std::hypot(x, 0.3), 0.1 * radius + size({x, 0, 0})) << x;
  }
  const TetCriteria tets = graded({2, 3.0}, size, depth, 0.5);
  EXPECT_EQ(tets.cell_size.minimum(), 1);
  EXPECT_EQ(tets.cell_size.maximum(), 3);
  EXPECT_NEAR(tets.cell_size({radius - 0.2, 0, 0}), 2, 0.7);
  EXPECT_EQ(tets.cell_size({0, 0, 0}), 3);
}

}  // namespace
}  // namespace delvox
