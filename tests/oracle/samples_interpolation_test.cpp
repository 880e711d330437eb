#include "oracle/samples_interpolation.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/natural_neighbor_coordinates_3.h>
#include <gtest/gtest.h>

#include <map>

#include "delvox/core/errors.h"
#include "delvox/oracle/samples_oracle.h"
#include "support/test_samples.h"

namespace delvox {
namespace {

double affine(const Point3& p) {
  return 3 * p.x - 2 * p.y + 0.5 * p.z + 7;
}

/// Random places; a lattice, where many samples lie on one sphere and in one plane; one that is nearly that; and one
/// far away from the origin, turned, so that its faces are planes to rounding only.
std::vector<std::pair<const char*, Samples>> places() {
  Samples turned = test::lattice_of_places(7, 0, 1);
  for (Point3& p : turned.points) {
    const double c = std::cos(0.3), s = std::sin(0.3);
    p = Point3{c * p.x - s * p.y, c * (s * p.x + c * p.y) - s * p.z, s * (s * p.x + c * p.y) + c * p.z} +
        Point3{100, -50, 300};
  }
  return {{"random", test::cube_of_places(400, 1)},
          {"lattice", test::lattice_of_places(7, 0, 1)},
          {"nearly a lattice", test::lattice_of_places(7, 1e-9, 1)},
          {"turned lattice", turned}};
}

/// Points of the hull, and of edges and faces of its tets.
std::vector<Point3> questions(const Samples& samples, int count) {
  test::Random random(2);
  const int n = static_cast<int>(samples.points.size());
  const auto any = [&] { return samples.points[static_cast<std::size_t>(random.below(n))]; };
  std::vector<Point3> points;
  for (int i = 0; i < count; ++i) {
    const double s = random.unit(), t = random.unit();
    points.push_back(midpoint(any(), any()));
    points.push_back((1 - s) * any() + (s * (1 - t)) * any() + (s * t) * any());
    points.push_back((1 - s) * midpoint(any(), any()) + s * midpoint(any(), any()));
  }
  return points;
}

TEST(SamplesInterpolation, LinearFunctionsComeBackToRoundingWhateverThePlaces) {
  for (const auto& [name, where] : places()) {
    const SampleField field(test::with_values(where, affine));
    int asked = 0;
    for (const Point3& p : questions(where, 150)) {
      for (Interpolation how : {Interpolation::kLinear, Interpolation::kNatural}) {
        const double value = field.value(p, how);
        if (std::isnan(value)) continue;  // rounded out of the hull
        ++asked;
        ASSERT_NEAR(value, affine(p), how == Interpolation::kLinear ? 1e-10 : 1e-8) << name << " " << int(how);
      }
    }
    EXPECT_GT(asked, 600) << name;
  }
}

TEST(SamplesInterpolation, SamplesKeepTheirValuesAndOutsideTheHullThereIsNone) {
  const Samples samples = test::with_values(test::cube_of_places(200, 3), test::ball);
  const SampleField field(samples);
  for (Interpolation how : {Interpolation::kLinear, Interpolation::kNatural}) {
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      EXPECT_NEAR(field.value(samples.points[i], how), samples.values[i], 1e-15);
    }
    EXPECT_TRUE(std::isnan(field.value({1.001, 0, 0}, how)));
    EXPECT_FALSE(std::isnan(field.value({1, 0.3, 0.1}, how)));  // on the hull
    EXPECT_TRUE(std::isnan(field.value({1e9, 1e9, -1e9}, how)));
  }
}

TEST(SamplesInterpolation, NaturalNeighborCoordinatesAreThoseOfCgal) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Base = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
  using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Base, Cell>>;
  const Samples samples = test::cube_of_places(400, 4);
  const SampleTriangulation ours(samples.points);
  Delaunay theirs;
  for (std::uint32_t i = 0; i < samples.points.size(); ++i) {
    const Point3& p = samples.points[i];
    theirs.insert(Kernel::Point_3(p.x, p.y, p.z))->info() = i;
  }
  test::Random random(5);
  const Box3 within{{-0.7, -0.7, -0.7}, {0.7, 0.7, 0.7}};
  for (int n = 0; n < 500; ++n) {
    const Point3 p = random.in(within);
    std::vector<std::pair<Delaunay::Vertex_handle, double>> expected;
    double whole = 0;
    ASSERT_TRUE(CGAL::sibson_natural_neighbor_coordinates_3(theirs, Kernel::Point_3(p.x, p.y, p.z),
                                                            std::back_inserter(expected), whole)
                    .third);
    std::map<std::uint32_t, double> found;
    for (const auto& [sample, weight] : natural_coordinates(ours, ours.locate(p), p)) found[sample] = weight;
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [vertex, volume] : expected) ASSERT_NEAR(found.at(vertex->info()), volume / whole, 1e-8);
  }
}

/// Root mean square of what a derivative along x errs by, taken over a step short against the tets.
double slope_error(const SampleField& field, Interpolation how, const test::Function& f) {
  test::Random random(7);
  const Box3 within{{-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}};
  constexpr double kStep = 1e-3;
  double sum = 0;
  for (int n = 0; n < 2000; ++n) {
    const Point3 p = random.in(within), q = p + Vector3{kStep, 0, 0};
    sum += std::pow((field.value(q, how) - field.value(p, how) - f(q) + f(p)) / kStep, 2);
  }
  return std::sqrt(sum / 2000);
}

// Values do not: of all means of samples that yield p itself, the Delaunay tet's has the least spread about p, and so
// the least error where the function curves alike in all directions.
TEST(SamplesInterpolation, NaturalNeighborsSlopesErrLessThanLinearOnes) {
  const auto smooth = [](const Point3& p) { return std::sin(2 * p.x) * std::cos(1.5 * p.y) + p.z * p.z; };
  const SampleField field(test::with_values(test::cube_of_places(3000, 6), smooth));
  const double linear = slope_error(field, Interpolation::kLinear, smooth);
  const double natural = slope_error(field, Interpolation::kNatural, smooth);
  EXPECT_LT(natural, 0.7 * linear);
}

TEST(SamplesInterpolation, PlacesInOnePlaneAreRefused) {
  Samples flat;
  for (int i = 0; i < 20; ++i) flat.points.push_back({double(i % 5), double(i / 5), 2.0 * (i % 5) - i / 5});
  flat.values.assign(20, 1);
  EXPECT_THROW(SampleField{flat}, InputError);
}

}  // namespace
}  // namespace delvox
