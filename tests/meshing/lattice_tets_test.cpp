#include "meshing/lattice_tets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "delaunay/circumsphere.h"
#include "delvox/core/mesh.h"

namespace delvox {
namespace {

using Site = LatticeTets::Site;
using Place = LatticeTets::Place;

class LatticeTetsTest : public testing::Test {
 protected:
  static constexpr std::array<std::int32_t, 3> kCounts{7, 5, 6};
  static constexpr Site kCorners = 7 * 5 * 6;

  /// In cubes.
  static Point3 point(Site site) {
    const double shift = site < kCorners ? 0 : 0.5;
    const Site cube = site % kCorners;
    return {cube % 7 + shift, cube / 7 % 5 + shift, cube / 35 + shift};
  }
  std::array<Point3, 4> points(Place place) const {
    const auto sites = lattice_.sites(place);
    return {point(sites[0]), point(sites[1]), point(sites[2]), point(sites[3])};
  }
  /// Of tets two cubes from the rim.
  template <class Visit>
  static void for_each_place(const Visit& visit) {
    for (Site corner = 0; corner < kCorners; ++corner) {
      const Point3 p = point(corner);
      if (p.x < 2 || p.y < 2 || p.z < 2 || p.x > 4 || p.y > 2 || p.z > 3) continue;
      for (Place number = 0; number < LatticeTets::kPerCorner; ++number) visit(corner * LatticeTets::kPerCorner + number);
    }
  }

  const LatticeTets lattice_{kCounts};
};

TEST_F(LatticeTetsTest, ArePositiveAllOfOneShapeAndFillTheCubes) {
  for_each_place([&](Place place) {
    const auto p = points(place);
    EXPECT_DOUBLE_EQ(dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6, 1.0 / LatticeTets::kPerCorner);
    const Circumsphere sphere = circumsphere(p[0], p[1], p[2], p[3]);
    EXPECT_DOUBLE_EQ(sphere.squared_radius, 5.0 / 16);
    for (Site site = 0; site < 2 * kCorners; ++site) {
      EXPECT_GE(squared_distance(point(site), sphere.center), sphere.squared_radius * (1 - 1e-12)) << "Delaunay";
    }
  });
}

TEST_F(LatticeTetsTest, AcrossAFaceLiesTheTetThatHasItToo) {
  for_each_place([&](Place place) {
    const auto sites = lattice_.sites(place);
    for (int face = 0; face < 4; ++face) {
      const Place beyond = lattice_.across(place, face);
      const auto others = lattice_.sites(beyond);
      int shared = 0, back = 0;
      for (int i = 0; i < 4; ++i) {
        shared += i != face && std::count(others.begin(), others.end(), sites[i]) == 1;
        back += lattice_.across(beyond, i) == place;
      }
      EXPECT_EQ(shared, 3);
      EXPECT_EQ(std::count(others.begin(), others.end(), sites[face]), 0);
      EXPECT_EQ(back, 1);
    }
  });
}

}  // namespace
}  // namespace delvox
