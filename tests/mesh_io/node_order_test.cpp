#include "mesh_io/node_order.h"

#include <gtest/gtest.h>

#include <set>

#include "delvox/core/mesh.h"

namespace delvox::mesh_io {
namespace {

/// The edges (numbers of corners in the file) on which the mid-side nodes of the file's order lie.
std::vector<std::pair<int, int>> edges_of(const NodeOrder& order) {
  std::array<int, 4> place{};  // of each of our corners among the file's corners
  int corners = 0;
  for (std::uint8_t own : order.tet10) {
    if (own < 4) place[own] = corners++;
  }
  std::vector<std::pair<int, int>> result;
  for (std::uint8_t own : order.tet10) {
    if (own < 4) continue;
    const int a = place[static_cast<std::size_t>(kTetEdges[own - 4][0])];
    const int b = place[static_cast<std::size_t>(kTetEdges[own - 4][1])];
    result.emplace_back(std::min(a, b), std::max(a, b));
  }
  return result;
}

TEST(NodeOrder, EveryTableIsAPermutation) {
  for (const NodeOrder& order : {kOwnOrder, kGmshOrder, kUnvOrder, kMedOrder}) {
    EXPECT_EQ(std::set<int>(order.tet4.begin(), order.tet4.end()).size(), 4u);
    EXPECT_EQ(std::set<int>(order.tet10.begin(), order.tet10.end()).size(), 10u);
    EXPECT_EQ(std::set<int>(order.triangle6.begin(), order.triangle6.end()).size(), 6u);
  }
}

// What each format's manual says of its mid-side nodes.
TEST(NodeOrder, MidSideNodesLieOnTheEdgesThatTheManualsName) {
  using Edges = std::vector<std::pair<int, int>>;
  EXPECT_EQ(edges_of(kOwnOrder), (Edges{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}));
  EXPECT_EQ(edges_of(kMedOrder), (Edges{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}));
  EXPECT_EQ(edges_of(kGmshOrder), (Edges{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}}));
  EXPECT_EQ(edges_of(kUnvOrder), (Edges{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}));
}

TEST(NodeOrder, AbaqusFacesHaveTheCornersOfItsManual) {
  const std::set<int> manual[4] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};  // S1 to S4
  for (std::size_t face = 0; face < 4; ++face) {
    const auto& corners = kTetFaces[face];
    EXPECT_EQ(std::set<int>(corners, corners + 3), manual[kAbaqusFace[face] - 1]);
  }
}

}  // namespace
}  // namespace delvox::mesh_io
