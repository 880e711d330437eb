#include "meshing/folds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "delaunay/restricted_triangles.h"
#include "support/random.h"
#include "support/shapes.h"

// Folds of triangulations of random points, whose restricted triangles meet at any angle, and by more than two.

namespace delvox {
namespace {

using Edge = std::array<VertexId, 2>;

/// A triangle at an edge: the unit vector across the edge within it, and the one into the domain from it.
struct Page {
  Vector3 along, inward;
};

class RandomFolds : public testing::TestWithParam<std::uint64_t> {
 protected:
  RandomFolds() {
    std::vector<Point3> points;
    for (int n = 0; n < 300; ++n) points.push_back(random_.in({{-15, -15, -15}, {15, 15, 15}}));
    delaunay_.insert_seeds(points);
  }

  Page page(const Edge& edge, FacetId facet) const {
    const auto v = delaunay_.vertices(facet);
    const Point3 &a = delaunay_.point(v[0]), &b = delaunay_.point(v[1]), &c = delaunay_.point(v[2]);
    const VertexId apex = v[0] + v[1] + v[2] - edge[0] - edge[1];
    const Vector3 axis = delaunay_.point(edge[1]) - delaunay_.point(edge[0]);
    Vector3 along = delaunay_.point(apex) - delaunay_.point(edge[0]);
    along = along - (dot(along, axis) / squared_norm(axis)) * axis;
    const Vector3 outward = cross(b - a, c - a);
    return {(1 / norm(along)) * along, (-1 / norm(outward)) * outward};
  }

  /// Angles of all wedges: at each edge from each triangle through the domain to the next.
  std::vector<double> wedges_below(double degrees) const {
    std::map<Edge, std::vector<Page>> edges;
    for (FacetId facet : restricted_triangles(delaunay_)) {
      const auto v = delaunay_.vertices(facet);
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge{std::min(v[i], v[(i + 1) % 3]), std::max(v[i], v[(i + 1) % 3])};
        edges[edge].push_back(page(edge, facet));
      }
    }
    std::vector<double> angles;
    for (const auto& [edge, pages] : edges) {
      for (const Page& from : pages) {
        double nearest = 360;
        for (const Page& to : pages) {
          if (&to == &from) continue;
          const double turned = std::atan2(dot(to.along, from.inward), dot(to.along, from.along)) * 180 / std::numbers::pi;
          nearest = std::min(nearest, turned < 0 ? turned + 360 : turned);
        }
        if (nearest < degrees) angles.push_back(nearest);
      }
    }
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  double angle_of(const Fold& fold) const {
    const auto v = delaunay_.vertices(fold.sides[0].facet), w = delaunay_.vertices(fold.sides[1].facet);
    std::vector<VertexId> common;
    std::copy_if(v.begin(), v.end(), std::back_inserter(common), [&](VertexId x) { return std::count(w.begin(), w.end(), x); });
    EXPECT_EQ(common.size(), 2u);
    const Edge edge{common[0], common[1]};
    const double cosine = dot(page(edge, fold.sides[0].facet).along, page(edge, fold.sides[1].facet).along);
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
  }

  using Key = std::array<std::uint32_t, 4>;
  static std::set<Key> keys(const std::vector<Fold>& folds) {
    std::set<Key> result;
    for (const Fold& fold : folds) {
      const auto &a = fold.sides[0].facet, &b = fold.sides[1].facet;
      Key key{a.cell, static_cast<std::uint32_t>(a.index), b.cell, static_cast<std::uint32_t>(b.index)};
      if (a.cell > b.cell || (a.cell == b.cell && a.index > b.index)) key = {key[2], key[3], key[0], key[1]};
      EXPECT_TRUE(result.insert(key).second) << "a fold comes twice";
    }
    return result;
  }

  test::Random random_{GetParam()};
  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle("shells", test::cubic_image(32));
  RestrictedDelaunay delaunay_{*oracle_};
};

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFolds, testing::Values(1, 2, 3));

TEST_P(RandomFolds, AreAllWedgesOfTheDomainSharperThanTheBoundEachFromBothSides) {
  for (double degrees : {30.0, 45.0, 90.0}) {
    const std::vector<Fold> folds = sharp_folds(delaunay_, degrees, 0);
    keys(folds);
    std::vector<double> angles;
    for (const Fold& fold : folds) {
      for (const Fold::Side& side : fold.sides) {
        EXPECT_TRUE(delaunay_.bipolar(side.facet));
        EXPECT_NE(delaunay_.label(side.facet.cell), 0);
        EXPECT_EQ(delaunay_.stamp(side.facet.cell), side.stamp);
      }
      angles.insert(angles.end(), 2, angle_of(fold));
    }
    std::sort(angles.begin(), angles.end());
    const std::vector<double> expected = wedges_below(degrees);
    ASSERT_EQ(angles.size(), expected.size()) << degrees;
    for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_NEAR(angles[i], expected[i], 1e-6);
    EXPECT_GT(angles.size(), degrees < 90 ? 0u : 20u);
  }
}

TEST_P(RandomFolds, ThatAreNewAreThoseOfCellsMadeSince) {
  const std::set<Key> before = keys(sharp_folds(delaunay_, 60, 0));
  const std::uint32_t new_from = delaunay_.next_stamp();
  EXPECT_TRUE(sharp_folds(delaunay_, 60, new_from).empty());
  for (int n = 0; n < 20; ++n) {
    delaunay_.evaluate(random_.in({{-12, -12, -12}, {12, 12, 12}}), delaunay_.some_cell());
    delaunay_.commit(VertexKind::kSurface);
  }
  const std::set<Key> now = keys(sharp_folds(delaunay_, 60, 0)), found = keys(sharp_folds(delaunay_, 60, new_from));
  EXPECT_GT(found.size(), 2u);
  EXPECT_LT(found.size(), now.size());
  EXPECT_TRUE(std::includes(now.begin(), now.end(), found.begin(), found.end()));
  for (const Key& key : now) EXPECT_TRUE(found.count(key) || before.count(key));
}

}  // namespace
}  // namespace delvox
