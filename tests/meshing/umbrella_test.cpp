#include "meshing/umbrella.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "meshing/extract.h"
#include "meshing/pieces.h"
#include "support/random.h"
#include "support/shapes.h"
#include "support/surface_measures.h"

// Umbrellas, pieces and extraction on triangulations of random points, whose restricted complexes are anything but
// manifold.

namespace delvox {
namespace {

/// Of all restricted triangles.
void compute_balls(RestrictedDelaunay& delaunay) {
  for (CellId c = RestrictedDelaunay::kBeyond + 1; c < delaunay.cell_capacity(); ++c) {
    for (int i = 0; i < 4 && delaunay.stamp(c) != 0; ++i) {
      if (delaunay.bipolar({c, i}) && delaunay.ball({c, i}) == nullptr) delaunay.compute_ball({c, i});
    }
  }
}

class RandomComplex : public testing::TestWithParam<std::uint64_t> {
 protected:
  RandomComplex() {
    test::Random random(GetParam());
    std::vector<Point3> points;
    for (int n = 0; n < 250; ++n) points.push_back(random.in({{-15, -15, -15}, {15, 15, 15}}));
    delaunay_.insert_seeds(points);
  }

  bool alive(CellId cell) const { return delaunay_.stamp(cell) != 0; }

  std::unique_ptr<SmoothOracle> oracle_ = test::voxel_phantom_oracle("shells", test::cubic_image(32));
  RestrictedDelaunay delaunay_{*oracle_};
};

INSTANTIATE_TEST_SUITE_P(Seeds, RandomComplex, testing::Values(1, 2, 3));

TEST_P(RandomComplex, UmbrellasHoldTheRestrictedTrianglesAtAVertexAndTellWhetherTheyAreOneFan) {
  const SurfaceMesh mesh = extract_surface(delaunay_);
  std::map<std::array<double, 3>, std::vector<Triangle>> around;
  for (const Triangle& t : mesh.triangles) {
    for (std::uint32_t v : t) around[{mesh.points[v].x, mesh.points[v].y, mesh.points[v].z}].push_back(t);
  }
  int disks = 0, others = 0;
  for (VertexId v = 4; v < delaunay_.vertex_capacity(); ++v) {
    const Point3& p = delaunay_.point(v);
    const auto& triangles = around[{p.x, p.y, p.z}];
    const Umbrella umbrella = find_umbrella(delaunay_, v);
    ASSERT_EQ(umbrella.facets.size(), triangles.size());
    for (const FacetId& facet : umbrella.facets) EXPECT_TRUE(delaunay_.bipolar(facet));
    // One fan: every other corner is in exactly two of the triangles, and they hang together around the vertex.
    std::map<std::uint32_t, std::vector<std::uint32_t>> link;
    for (const Triangle& t : triangles) {
      for (int i = 0; i < 3; ++i) {
        if (mesh.points[t[i]] != p) continue;
        link[t[(i + 1) % 3]].push_back(t[(i + 2) % 3]);
        link[t[(i + 2) % 3]].push_back(t[(i + 1) % 3]);
      }
    }
    bool disk = std::all_of(link.begin(), link.end(), [](const auto& entry) { return entry.second.size() == 2; });
    std::set<std::uint32_t> reached;
    std::vector<std::uint32_t> stack;
    if (!link.empty()) stack.push_back(link.begin()->first);
    while (!stack.empty()) {
      const std::uint32_t at = stack.back();
      stack.pop_back();
      if (reached.insert(at).second) stack.insert(stack.end(), link[at].begin(), link[at].end());
    }
    disk &= reached.size() == link.size();
    EXPECT_EQ(umbrella.disk, disk);
    (disk ? disks : others) += 1;
  }
  EXPECT_GT(disks, 5);
  EXPECT_GT(others, 5);
}

TEST_P(RandomComplex, ASweepFindsTheSameBrokenUmbrellasAsAWalkAroundEachVertex) {
  compute_balls(delaunay_);
  std::vector<VertexId> all, few, broken, few_broken;
  for (VertexId v = 4; v < delaunay_.vertex_capacity(); ++v) {
    all.push_back(v);
    const bool bad = !find_umbrella(delaunay_, v).disk;
    if (bad) broken.push_back(v);
    if (v % 50 != 0) continue;
    few.push_back(v);
    if (bad) few_broken.push_back(v);
  }
  EXPECT_EQ(without_disk(delaunay_, all), broken);
  EXPECT_EQ(without_disk(delaunay_, few), few_broken);
}

// More triangles than a sweep gathers the links of.
TEST(Umbrella, OfManyTrianglesIsADiskToo) {
  constexpr int kAround = 40;
  const auto oracle = test::unit_ball();
  RestrictedDelaunay delaunay(*oracle);
  std::vector<Point3> points{{0, 0, 1}, {0, 0, -1}};
  for (int n = 0; n < kAround; ++n) {
    const double angle = 2 * std::numbers::pi * n / kAround;
    for (double z : {0.8, 0.0, -0.8}) {
      const double radius = std::sqrt(1 - z * z);
      points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  const VertexId pole = delaunay.insert_seeds(points).front();
  compute_balls(delaunay);
  EXPECT_EQ(find_umbrella(delaunay, pole).facets.size(), static_cast<std::size_t>(kAround));
  std::vector<VertexId> all(delaunay.vertex_capacity());
  std::iota(all.begin(), all.end(), VertexId{0});
  EXPECT_TRUE(without_disk(delaunay, all).empty());
}

TEST_P(RandomComplex, PiecesAreTheCellsOfOneLabelThatFacetsJoin) {
  test::detail::UnionFind expected(delaunay_.cell_capacity());
  constexpr CellId kFirst = RestrictedDelaunay::kBeyond + 1;
  for (CellId c = kFirst; c < delaunay_.cell_capacity(); ++c) {
    if (!alive(c)) continue;
    for (CellId n : delaunay_.neighbors(c)) {
      if (n != RestrictedDelaunay::kBeyond && delaunay_.label(c) == delaunay_.label(n)) expected.join(c, n);
    }
  }
  Pieces pieces(delaunay_);
  std::map<std::size_t, std::uint32_t> piece_of_root;
  for (CellId c = kFirst; c < delaunay_.cell_capacity(); ++c) {
    if (!alive(c)) continue;
    ASSERT_LT(pieces.of(c), pieces.count());
    const auto [entry, is_new] = piece_of_root.try_emplace(expected.root(c), pieces.of(c));
    EXPECT_EQ(entry->second, pieces.of(c));
  }
  EXPECT_EQ(piece_of_root.size(), pieces.count());
}

TEST_P(RandomComplex, ExtractionGivesTheInsideCellsAndTheirBoundary) {
  const TetMesh mesh = extract_tets(delaunay_);
  std::size_t inside = 0;
  for (CellId c = 0; c < delaunay_.cell_capacity(); ++c) inside += alive(c) && delaunay_.label(c) != 0;
  EXPECT_EQ(mesh.tets.size(), inside);
  EXPECT_EQ(mesh.regions.size(), inside);
  EXPECT_EQ(mesh.boundary.size(), boundary_of(mesh.tets).size());
  const SurfaceMesh surface = extract_surface(delaunay_);
  EXPECT_EQ(surface.triangles.size(), mesh.boundary.size());
  EXPECT_NEAR(test::enclosed_volume(surface), test::enclosed_volume(boundary_surface(mesh)), 1e-9);
  EXPECT_GT(test::enclosed_volume(surface), 0);
}

}  // namespace
}  // namespace delvox
