#include "delaunay/predicates.h"

#include <CGAL/Exact_rational.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/random.h"

namespace delvox {
namespace {

using Rational = CGAL::Exact_rational;
using test::Random;
using Five = std::array<Point3, 5>;

int sign_of(const Rational& value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// a - b and its squared length, exactly.
std::array<Rational, 4> lifted(const Point3& a, const Point3& b) {
  std::array<Rational, 4> row;
  for (int axis = 0; axis < 3; ++axis) {
    row[axis] = Rational(a[axis]) - Rational(b[axis]);
    row[3] += row[axis] * row[axis];
  }
  return row;
}

using Row = std::array<Rational, 4>;

Rational determinant3(const Row& a, const Row& b, const Row& c, int x, int y, int z) {
  return a[x] * (b[y] * c[z] - b[z] * c[y]) - a[y] * (b[x] * c[z] - b[z] * c[x]) + a[z] * (b[x] * c[y] - b[y] * c[x]);
}

int exact_orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return sign_of(determinant3(lifted(b, a), lifted(c, a), lifted(d, a), 0, 1, 2));
}

/// 1 inside, 0 on the sphere, -1 outside, of a positive tet.
int exact_side(const Five& p) {
  const Row a = lifted(p[0], p[4]), b = lifted(p[1], p[4]), c = lifted(p[2], p[4]), d = lifted(p[3], p[4]);
  const Rational value = a[3] * determinant3(b, c, d, 0, 1, 2) - b[3] * determinant3(a, c, d, 0, 1, 2) +
                         c[3] * determinant3(a, b, d, 0, 1, 2) - d[3] * determinant3(a, b, c, 0, 1, 2);
  return sign_of(value);
}

Point3 nudged(Random& random, Point3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int ulps = random.below(3); ulps > 0; --ulps) p[axis] = std::nextafter(p[axis], random.below(2) ? 9e9 : -9e9);
  }
  return p;
}

/// Points of a coarse grid: most fives are coplanar or cospherical in some way.
Point3 on_grid(Random& random, int n) {
  return {0.1 * random.below(n), 0.1 * random.below(n), 0.1 * random.below(n)};
}

/// Every integer point of the sphere x^2 + y^2 + z^2 = 41, exactly cospherical; 8 and 12 of them share planes.
Point3 on_integer_sphere(Random& random) {
  static const std::array<std::array<double, 3>, 3> kinds{{{6, 2, 1}, {4, 4, 3}, {0, 5, 4}}};
  std::array<double, 3> p = kinds[random.below(3)];
  for (int i = 2; i > 0; --i) std::swap(p[i], p[random.below(i + 1)]);
  for (double& x : p) x = random.below(2) ? x : -x;
  return {p[0], p[1], p[2]};
}

bool make_positive(Five& p) {
  const int sign = exact_orientation(p[0], p[1], p[2], p[3]);
  if (sign < 0) std::swap(p[0], p[1]);
  return sign != 0;
}

bool inside(const Five& p) {
  return in_sphere(p[0], p[1], p[2], p[3], p[4]);
}

template <class Next>
void expect_exact(std::uint64_t seed, int count, int most_ties, const Next& next) {
  Random random(seed);
  int ties = 0;
  for (int n = 0; n < count; ++n) {
    Five p;
    for (Point3& q : p) q = next(random);
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), exact_orientation(p[0], p[1], p[2], p[3])) << n;
    if (!make_positive(p)) continue;
    const int side = exact_side(p);
    ties += side == 0;
    if (side != 0) {
      ASSERT_EQ(inside(p), side > 0) << n;
    }
  }
  EXPECT_LE(ties, most_ties);
}

TEST(Predicates, AreExactOnRandomPoints) {
  expect_exact(1, 3000, 0, [](Random& random) { return random.in({{-5, 1, 100}, {3, 2, 400}}); });
}

TEST(Predicates, AreExactWithinAFewUlpsOfPlanesAndSpheres) {
  expect_exact(2, 5000, 5000, [](Random& random) { return nudged(random, on_grid(random, 4)); });
  expect_exact(3, 3000, 3000, [](Random& random) { return nudged(random, on_integer_sphere(random)); });
  expect_exact(4, 3000, 3000, [](Random& random) { return nudged(random, 1e-3 * random.direction()); });
}

TEST(Predicates, AreExactOnGridsPlanesAndLines) {
  expect_exact(5, 5000, 5000, [](Random& random) { return on_grid(random, 3); });
  expect_exact(6, 2000, 0, [](Random& random) { return Point3{random.unit(), random.unit(), 0.25}; });
  expect_exact(7, 2000, 2000, [](Random& random) {
    const double t = 0.1 * random.below(9);
    return random.below(3) ? Point3{t, 2 * t, -t} : on_grid(random, 5);
  });
}

TEST(Predicates, AreExactFarFromTheOriginAndAtTinyAndHugeScales) {
  for (const double scale : {1e-30, 1e-6, 1e6, 1e30}) {
    expect_exact(8, 500, 500, [&](Random& random) { return scale * nudged(random, on_grid(random, 4)); });
  }
  expect_exact(9, 2000, 2000, [](Random& random) {
    return Point3{1e8, -3e8, 2e8} + random.in({{0, 0, 0}, {1e-5, 1e-5, 1e-5}});
  });
}

/// Five points in every order that leaves the tet positive give one answer for each choice of the fifth.
void expect_order_does_not_matter(Five p) {
  std::array<int, 4> order{0, 1, 2, 3};
  const bool expected = inside(p);
  do {
    const Five q{p[order[0]], p[order[1]], p[order[2]], p[order[3]], p[4]};
    if (exact_orientation(q[0], q[1], q[2], q[3]) > 0) {
      ASSERT_EQ(inside(q), expected);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

/// Five points have two triangulations (Radon): the tets without the points of one part, or those without the points of
/// the other. A tet is Delaunay if the point that it leaves out is not inside: true of the tets of exactly one part.
void expect_one_triangulation(const Five& p) {
  std::array<std::vector<bool>, 2> delaunay;  // of each part's tets
  for (int out = 0; out < 5; ++out) {
    Five q;
    for (int i = 0, at = 0; i < 5; ++i) {
      if (i != out) q[at++] = p[i];
    }
    q[4] = p[out];
    // Swapping the left-out point to the end changes the sign by that of the permutation.
    const int sign = exact_orientation(q[0], q[1], q[2], q[3]);
    if (!make_positive(q)) continue;
    expect_order_does_not_matter(q);
    delaunay[(sign > 0) == (out % 2 == 0)].push_back(!inside(q));
  }
  for (const auto& part : delaunay) {
    ASSERT_FALSE(part.empty());  // cospherical points are in convex position
    for (const bool is : part) ASSERT_EQ(is, part.front());
  }
  EXPECT_NE(delaunay[0].front(), delaunay[1].front());
}

template <class Next>
void expect_unique(std::uint64_t seed, const Next& next) {
  Random random(seed);
  int tested = 0;
  for (int n = 0; n < 20000 && tested < 400; ++n) {
    Five p;
    for (Point3& q : p) q = next(random);
    bool distinct = true;
    for (int i = 0; i < 5; ++i) distinct &= std::count(p.begin(), p.end(), p[i]) == 1;
    Five tet = p;
    // Four of them may be coplanar, not all five.
    for (int turn = 0; turn < 5 && exact_orientation(tet[0], tet[1], tet[2], tet[3]) == 0; ++turn) {
      std::rotate(tet.begin(), tet.begin() + 1, tet.end());
    }
    if (!distinct || !make_positive(tet) || exact_side(tet) != 0) continue;
    ++tested;
    expect_one_triangulation(p);
    ASSERT_FALSE(testing::Test::HasFailure()) << n;
  }
  EXPECT_EQ(tested, 400);
}

TEST(Predicates, OfTwoTriangulationsOfFiveCosphericalPointsExactlyOneIsDelaunayInAnyOrder) {
  expect_unique(10, on_integer_sphere);
  expect_unique(11, [](Random& random) {  // corners of a cube: any four of a face are cocircular
    return Point3{3.0 + random.below(2), -7.0 + random.below(2), 0.5 + random.below(2)};
  });
  expect_unique(12, [](Random& random) { return Point3{1.0 * random.below(3), 1.0 * random.below(3), 1.0 * random.below(3)}; });
  expect_unique(13, [](Random& random) {  // cocircular points and an apex above
    static const std::array<Point3, 5> p{{{5, 0, 0}, {3, 4, 0}, {-4, 3, 0}, {0, -5, 0}, {0, 0, 5}}};
    return p[random.below(5)];
  });
}

}  // namespace
}  // namespace delvox
