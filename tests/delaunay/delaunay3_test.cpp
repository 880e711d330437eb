#include "delaunay/delaunay3.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "against_cgal.h"

namespace delvox {
namespace {

using test::AgainstCgal;
using test::kUnitBox;
using test::Placement;
using test::Random;

class Delaunay3Suite : public testing::TestWithParam<Placement> {};

INSTANTIATE_TEST_SUITE_P(Placements, Delaunay3Suite, testing::ValuesIn(test::kPlacements),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(Delaunay3Suite, IsCgalsComplexThroughInsertionsAndRemovals) {
  AgainstCgal pair(kUnitBox, 1);
  for (int n = 0; n < 2000; ++n) {
    pair.step(GetParam().next, n < 1000 ? 0.2 : 0.5);
    if (n % 400 == 399) pair.expect_equal();
    ASSERT_FALSE(HasFailure()) << n;
  }
  pair.expect_locally_delaunay();
}

TEST_P(Delaunay3Suite, EmptiesToTheFirstCellAndFillsAgainToTheSameComplex) {
  AgainstCgal pair(kUnitBox, 2);
  for (int n = 0; n < 150; ++n) pair.step(GetParam().next, 0);
  const auto full = pair.ours();
  const std::vector<Point3> points = pair.points();
  while (!pair.points().empty()) pair.remove_one();
  pair.expect_equal();
  EXPECT_EQ(pair.delaunay().vertex_count(), 4u);
  EXPECT_EQ(pair.ours().size(), 1u);
  const std::size_t cells = pair.delaunay().cell_capacity();
  for (auto p = points.rbegin(); p != points.rend(); ++p) pair.insert(*p);
  EXPECT_EQ(pair.ours(), full);
  EXPECT_LE(pair.delaunay().cell_capacity(), 2 * cells);  // numbers are used again
  pair.expect_locally_delaunay();
}

TEST_P(Delaunay3Suite, IsTheSameToTheLastNumberOnASecondRun) {
  AgainstCgal first(kUnitBox, 3), second(kUnitBox, 3);
  for (int n = 0; n < 500; ++n) {
    first.step(GetParam().next, 0.3);
    second.step(GetParam().next, 0.3);
  }
  const Delaunay3 &a = first.delaunay(), &b = second.delaunay();
  ASSERT_EQ(a.cell_capacity(), b.cell_capacity());
  for (CellId cell = 0; cell < a.cell_capacity(); ++cell) {
    ASSERT_EQ(a.stamp(cell), b.stamp(cell));
    if (a.stamp(cell) == 0) continue;
    ASSERT_EQ(a.vertices(cell), b.vertices(cell));
    ASSERT_EQ(a.neighbors(cell), b.neighbors(cell));
    ASSERT_EQ(a.sphere(cell).center, b.sphere(cell).center);
  }
}

TEST_P(Delaunay3Suite, DoesNotDependOnTheOrderOfInsertion) {
  AgainstCgal forward(kUnitBox, 4), backward(kUnitBox, 4);
  for (int n = 0; n < 300; ++n) forward.step(GetParam().next, 0);
  const std::vector<Point3> points = forward.points();
  for (auto p = points.rbegin(); p != points.rend(); ++p) backward.insert(*p);
  EXPECT_EQ(forward.ours(), backward.ours());
}

/// Exactly cocircular: integer points of x^2 + y^2 = 5^2 13^2 17^2 (108 of them), at `height`.
std::vector<Point3> integer_circle(double height) {
  constexpr int kRadius = 1105;
  std::vector<Point3> points;
  for (int x = -kRadius; x <= kRadius; ++x) {
    const int y = static_cast<int>(std::lround(std::sqrt(double(kRadius) * kRadius - double(x) * x)));
    if (x * x + y * y != kRadius * kRadius) continue;
    points.push_back({double(x), double(y), height});
    if (y != 0) points.push_back({double(x), -double(y), height});
  }
  return points;
}

/// Exactly cospherical: integer points of a sphere whose squared radius many sums of three squares make.
std::vector<Point3> integer_sphere(int squared_radius) {
  std::vector<Point3> points;
  const int r = static_cast<int>(std::sqrt(squared_radius));
  for (int x = -r; x <= r; ++x) {
    for (int y = -r; y <= r; ++y) {
      const int left = squared_radius - x * x - y * y;
      const int z = left < 0 ? 0 : static_cast<int>(std::lround(std::sqrt(left)));
      if (left < 0 || z * z != left) continue;
      points.push_back({double(x), double(y), double(z)});
      if (z != 0) points.push_back({double(x), double(y), -double(z)});
    }
  }
  return points;
}

Box3 cube(double half) {
  return {{-half, -half, -half}, {half, half, half}};
}

TEST(Delaunay3, TakesAPointInTheMiddleOfHundredsOfCosphericalOnesAndItsRemoval) {
  AgainstCgal pair(cube(150), 5);
  for (const Point3& p : integer_sphere(14081)) pair.insert(p);
  ASSERT_GT(pair.points().size(), 500u);
  const auto before = pair.ours();
  const std::size_t zone = pair.insert({0, 0, 0});
  EXPECT_GT(zone, 500u);  // the whole ball
  pair.expect_equal();
  pair.remove_last();
  EXPECT_EQ(pair.ours(), before);
  pair.insert({0.5, -0.25, 7});  // as near to the middle as makes its zone as large
  pair.insert({1, -0.25, 7});
  pair.expect_equal();
  pair.expect_locally_delaunay();
}

TEST(Delaunay3, TakesPointsOnTheAxisOfCocircularOnes) {
  AgainstCgal pair(cube(1200), 6);
  for (const Point3& p : integer_circle(0)) pair.insert(p);
  ASSERT_GT(pair.points().size(), 100u);
  pair.expect_equal();
  for (const double height : {0.0, 300.0, -300.0, 1105.0, 1e-9}) {
    EXPECT_GT(pair.insert({0, 0, height}), 10u);
    pair.expect_equal();
  }
  for (int n = 0; n < 5; ++n) {
    pair.remove_last();
    pair.expect_equal();
  }
  pair.expect_locally_delaunay();
}

TEST(Delaunay3, RemovesAVertexWithAThousandNeighbours) {
  AgainstCgal pair(kUnitBox, 7);
  Random random(7);
  for (int n = 0; n < 1000; ++n) pair.insert((0.5 + 0.01 * random.unit()) * random.direction());
  const auto before = pair.ours();
  const Point3 p{0.01, 0.02, 0.03};
  EXPECT_GT(pair.insert(p), 1000u);
  pair.expect_equal();
  pair.remove_last();
  EXPECT_EQ(pair.ours(), before);
  pair.expect_equal();
}

TEST(Delaunay3, TakesPointsOnTheFacesEdgesAndCornersOfItsBounds) {
  AgainstCgal pair(kUnitBox, 8);
  for (int code = 0; code < 27; ++code) {
    pair.insert({code % 3 - 1.0, code / 3 % 3 - 1.0, code / 9 - 1.0});
  }
  Random random(8);
  for (int n = 0; n < 300; ++n) {
    Point3 p = random.in(kUnitBox);
    p[random.below(3)] = random.below(2) ? 1 : -1;
    pair.insert(p);
  }
  pair.expect_equal();
  for (int n = 0; n < 200; ++n) pair.remove_one();  // most of them have corners for neighbours
  pair.expect_equal();
  pair.expect_locally_delaunay();
}

TEST(Delaunay3, FindsEveryVertexAgainAsADuplicateFromEveryCell) {
  for (const Placement& placement : test::kPlacements) {
    AgainstCgal pair(kUnitBox, 9);
    for (int n = 0; n < 60; ++n) pair.step(placement.next, 0.1);
    const Delaunay3& delaunay = pair.delaunay();
    Star star;
    for (const Point3& p : pair.points()) {
      for (CellId hint = 1; hint < delaunay.cell_capacity(); ++hint) {
        if (delaunay.stamp(hint) == 0) continue;
        delaunay.evaluate(p, hint, star);
        ASSERT_TRUE(star.duplicate) << placement.name;
        EXPECT_TRUE(star.zone.empty() && star.tets.empty());
      }
    }
  }
}

TEST(Delaunay3, LocatesPointsFromAnyHint) {
  AgainstCgal pair(kUnitBox, 10);
  for (int n = 0; n < 500; ++n) pair.step(test::on_lattice, 0.2);
  const Delaunay3& delaunay = pair.delaunay();
  Random random(10);
  for (int n = 0; n < 2000; ++n) {
    const Point3 p = n % 2 ? random.in(kUnitBox) : test::on_lattice(random);
    const CellId hint = 1 + static_cast<CellId>(random.below(static_cast<int>(delaunay.cell_capacity()) - 1));
    if (delaunay.stamp(hint) == 0) continue;
    const CellId cell = delaunay.locate(p, hint);
    ASSERT_NE(cell, Delaunay3::kOutside);
    for (int i = 0; i < 4; ++i) {
      const auto v = delaunay.vertices(FacetId{cell, i});
      EXPECT_LE(test::signed_volume(delaunay.point(v[0]), delaunay.point(v[1]), delaunay.point(v[2]), p), 0);
    }
  }
}

TEST(Delaunay3, StarTetsHaveTheSpheresThatTheirCornersAloneGive) {
  AgainstCgal pair(cube(1), 12);
  Random random(13);
  for (int n = 0; n < 300; ++n) pair.insert(random.in(cube(1)));
  pair.insert({0.25, 0.5, 0.5});
  pair.insert({0.5, 0.5, 0.5});
  pair.insert({0.75, 0.5, 0.5 + 1e-14});  // tets at these are too flat for double
  const Delaunay3& delaunay = pair.delaunay();
  Star star;
  for (int n = 0; n < 200; ++n) {
    const Point3 p = n == 0 ? Point3{0.6, 0.5, 0.5} : random.in(cube(1));
    delaunay.evaluate(p, delaunay.cell_of(0), star);
    ASSERT_EQ(star.tets.size() % 2, 0u);  // spheres are found for two tets at a time
    for (const Star::Tet& tet : star.tets) {
      const auto& v = tet.vertices;
      const Circumsphere alone = circumsphere(p, delaunay.point(v[0]), delaunay.point(v[1]), delaunay.point(v[2]));
      ASSERT_EQ(tet.sphere.center, alone.center);
      ASSERT_EQ(tet.sphere.squared_radius, alone.squared_radius);
    }
  }
}

TEST(Delaunay3, StarTetsAreJoinedAcrossTheirSharedEdges) {
  AgainstCgal pair(cube(150), 11);
  for (const Point3& p : integer_sphere(14081)) pair.insert(p);
  Star star;
  for (const Point3& p : {Point3{0, 0, 0}, Point3{60, 60, 60}, Point3{149, 149, 149}}) {  // by lists, and by table
    pair.delaunay().evaluate(p, pair.delaunay().cell_of(0), star);
    ASSERT_FALSE(star.tets.empty());
    for (std::uint32_t t = 0; t < star.tets.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        ASSERT_LT(star.tets[t].beside[i], star.tets.size());
        const Star::Tet& other = star.tets[star.tets[t].beside[i]];
        const auto back = std::find(other.beside.begin(), other.beside.end(), t) - other.beside.begin();
        ASSERT_LT(back, 3);
        EXPECT_EQ(star.tets[t].vertices[(i + 1) % 3], other.vertices[(back + 2) % 3]);
        EXPECT_EQ(star.tets[t].vertices[(i + 2) % 3], other.vertices[(back + 1) % 3]);
      }
    }
  }
}

TEST(Delaunay3, IsCgalsComplexFarFromTheOriginAndAtTinyAndHugeScales) {
  for (const double scale : {1e-9, 1e9}) {
    for (const Point3& shift : {Point3{}, scale * Point3{3e7, -1e7, 2e7}}) {
      AgainstCgal pair({shift + scale * kUnitBox.min, shift + scale * kUnitBox.max}, 12);
      Random random(12);
      for (int n = 0; n < 400; ++n) {
        pair.insert(shift + scale * test::anywhere(random));
        pair.insert(shift + scale * test::clustered(random));
        if (n % 3 == 0) pair.remove_one();
      }
      pair.expect_equal();
      pair.expect_locally_delaunay();
    }
  }
}

}  // namespace
}  // namespace delvox
