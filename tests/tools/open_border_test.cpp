#include "open_border.h"

#include <gtest/gtest.h>

namespace delvox::tools {
namespace {

VolumeHeader grid_of_ten() {
  VolumeHeader header;
  header.dims = {10, 10, 10};
  return header;
}

TEST(OpenBorder, TakesOutTrianglesThatTouchThePadding) {
  SurfaceMesh strip;
  strip.points = {{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {4, 4, 1}, {9.5, 2, 1}};
  strip.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}};
  const SurfaceMesh open = open_at_border(strip, grid_of_ten());
  EXPECT_EQ(open.triangles.size(), 2u);
  EXPECT_EQ(open.points.size(), 4u);
  EXPECT_TRUE(open.info.open_border);
}

TEST(OpenBorder, TakesOutWhatWouldHangOnByOnePoint) {
  SurfaceMesh pinched;  // two triangles side by side, and a third that shares the point 1 alone once 4 is gone
  pinched.points = {{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {4, 4, 1}, {8, 0, 1}, {8, 3, 1}};
  pinched.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 5}};
  const SurfaceMesh open = open_at_border(pinched, grid_of_ten());
  EXPECT_EQ(open.triangles.size(), 2u);
  EXPECT_EQ(open.points.size(), 4u);
}

}  // namespace
}  // namespace delvox::tools
