// What Refinement keeps between insertions, driven by hand to look at it.
#include "meshing/refinement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "phantom_cases.h"

namespace delvox {
namespace {

class KeptBalls : public testing::TestWithParam<test::PhantomCase> {};

INSTANTIATE_TEST_SUITE_P(
    Phantoms, KeptBalls,
    testing::Values(test::PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(64), 1), 1.5},
                    test::PhantomCase{"noisy-sphere", test::with_noise(test::cubic_image(64), 1.5), 4}),
    [](const auto& info) { return test::test_name(info.param) + "_" + std::to_string(info.index); });

// Whatever has been removed in between: a ball belongs to a bipolar facet, its centre lies on the facet's dual edge.
TEST_P(KeptBalls, AreThoseOfTheFacetsThatHaveThem) {
  const test::PhantomCase& c = GetParam();
  const auto oracle = make_isosurface_oracle(c.volume(), c.isosurface());
  SurfaceCriteria surface;
  surface.size = c.size;
  surface.min_ball_radius = c.min_ball_radius();
  const TetCriteria tets{2, c.size};
  const RunControl control;
  RunReport report;
  Refinement refinement(*oracle, surface, control, Variant{}, report);
  const auto refine = [&] {
    do {
      refinement.refine();
    } while (refinement.repair());
  };
  refinement.start();
  refine();
  refinement.fill_interior(tets);
  refinement.watch_tets(tets);
  refine();

  const RestrictedDelaunay& delaunay = refinement.delaunay();
  std::size_t balls = 0, strays = 0;
  for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay.cell_capacity(); ++cell) {
    if (delaunay.stamp(cell) == 0) continue;
    for (int i = 0; i < 4; ++i) {
      const FacetId facet{cell, i};
      const SurfaceBall* const ball = delaunay.ball(facet);
      if (ball == nullptr) continue;
      ++balls;
      const double radius = std::sqrt(ball->squared_radius), slack = 1e-6 * (radius + c.size);
      const auto away = [&](VertexId v) { return distance(delaunay.point(v), ball->center); };
      bool stray = !delaunay.bipolar(facet);
      for (VertexId v : delaunay.vertices(facet)) stray |= std::abs(away(v) - radius) > slack;
      const FacetId other = delaunay.mirror(facet);
      for (const FacetId& side : {facet, other}) {
        stray |= away(delaunay.vertices(side.cell)[side.index]) < radius - slack;
      }
      strays += stray;
    }
  }
  EXPECT_GT(report.removals, 0u) << "else this proves nothing";
  EXPECT_GT(balls, 0u);
  EXPECT_EQ(strays, 0u);
}

// By which Voronoi edges are cut before anybody looks for excursions on them: with the seeds alone, before refinement,
// wherever a Voronoi edge crosses the surface, its vertices are near.
TEST(SeedsOfFineMeshes, LieWithinTwoVoxelsAndTwoSizesOfWhereVoronoiEdgesCrossTheSurface) {
  for (const char* kind : {"random", "noisy-sphere", "gyroid"}) {
    for (const auto& [size, longest_voxel] : {std::array{0.25, 1.0}, {0.55, 1.0}, {0.55, 2.5}}) {
      SCOPED_TRACE(std::string(kind) + ", " + std::to_string(size) + ", " + std::to_string(longest_voxel));
      PhantomOptions image = test::with_noise(test::cubic_image(14), 1);
      image.spacing.z = longest_voxel;
      const auto oracle = test::voxel_phantom_oracle(kind, image);
      ASSERT_FALSE(oracle->landmarks(size, always_go_on).points.empty());
      RestrictedDelaunay delaunay(*oracle);
      delaunay.insert_seeds(oracle->seeds(size, always_go_on).points);
      std::size_t crossings = 0, far = 0;
      for (CellId cell = RestrictedDelaunay::kBeyond + 1; cell < delaunay.cell_capacity(); ++cell) {
        for (int i = 0; i < 4 && delaunay.stamp(cell) != 0; ++i) {
          if (delaunay.neighbors(cell)[i] < cell || !delaunay.proper({cell, i})) continue;
          const Point3& corner = delaunay.point(delaunay.vertices(FacetId{cell, i})[0]);
          for (const Point3& p : delaunay.dual_crossings({cell, i}, *oracle)) {
            ++crossings;
            far += distance(p, corner) > 2 * longest_voxel + 2 * size;
          }
        }
      }
      EXPECT_GT(crossings, 800u);
      EXPECT_EQ(far, 0u);
    }
  }
}

}  // namespace
}  // namespace delvox
