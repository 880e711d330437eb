#include "delvox/core/merge_points.h"

#include <gtest/gtest.h>

#include "support/test_meshes.h"

namespace delvox {
namespace {

TEST(MergePoints, ASoupOfTrianglesBecomesTheSurfaceItWasCutFrom) {
  const SurfaceMesh sphere = test::icosphere(2);
  SurfaceMesh soup;
  for (const Triangle& t : sphere.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.points.size());
    for (std::uint32_t v : t) soup.points.push_back(sphere.points[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  const SurfaceMesh merged = with_equal_points_merged(soup);
  EXPECT_EQ(merged.points.size(), sphere.points.size());
  ASSERT_EQ(merged.triangles.size(), sphere.triangles.size());
  for (std::size_t t = 0; t < merged.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(merged.points[merged.triangles[t][i]], sphere.points[sphere.triangles[t][i]]);
    }
  }
}

TEST(MergePoints, CollapsedTrianglesAndUnusedPointsGoAndTheOthersKnowTheirNumbers) {
  SurfaceMesh mesh;
  mesh.points = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}};
  mesh.triangles = {{1, 2, 4}, {4, 2, 3}};
  std::vector<std::uint32_t> kept;
  const SurfaceMesh merged = with_equal_points_merged(mesh, &kept);
  EXPECT_EQ(merged.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(merged.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(kept, (std::vector<std::uint32_t>{1}));
}

}  // namespace
}  // namespace delvox
