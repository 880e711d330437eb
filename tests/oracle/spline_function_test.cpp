#include "delvox/oracle/spline_function.h"

#include <gtest/gtest.h>

#include <cmath>

#include "delvox/core/errors.h"
#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

Volume noise(const std::array<int, 3>& dims) {
  test::Random random(3);
  VolumeHeader header;
  header.dims = dims;
  for (int axis = 0; axis < 3; ++axis) header.index_to_world.rows[axis][axis] = 0.5 + 0.25 * axis;
  std::vector<float> samples(static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]);
  for (float& sample : samples) sample = static_cast<float>(random.between(-1, 1));
  return Volume(header, samples);
}

TEST(SplineFunction, PassesThroughTheSamples) {
  const Volume volume = noise({7, 5, 6});
  const SmoothDomain domain = make_spline_domain(volume, {0.25, false});
  for (int k = 0; k < 6; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 7; ++i) {
        double h = 0;
        domain.function->evaluate({0.5 * i, 0.75 * j, 1.0 * k}, 0, &h);
        EXPECT_NEAR(h, 0.25 - static_cast<double>(volume.value(i, j, k)), 1e-6);
      }
    }
  }
}

TEST(SplineFunction, DerivativesAreThoseThatDifferencesShow) {
  const SmoothDomain domain = make_spline_domain(noise({6, 6, 6}), {0, false});
  constexpr std::size_t kOf[20] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3, 4, 4, 4, 5, 5, 6, 7, 7, 8, 9};
  constexpr int kAxis[20] = {0, 0, 1, 2, 0, 1, 2, 1, 2, 2, 0, 1, 2, 1, 2, 2, 1, 2, 2, 2};
  test::Random random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Point3 p = random.in({{0, 0, 0}, {2.5, 3.7, 5}});
    double at_p[20];
    domain.function->evaluate(p, 3, at_p);
    for (std::size_t i = 1; i < 20; ++i) {
      constexpr double kStep = 1e-5;
      Vector3 step;
      step[kAxis[i]] = kStep;
      double before[10], after[10];
      domain.function->evaluate(p - step, 2, before);
      domain.function->evaluate(p + step, 2, after);
      EXPECT_NEAR(at_p[i], (after[kOf[i]] - before[kOf[i]]) / (2 * kStep), 1e-4 * (1 + std::abs(at_p[i]))) << i;
    }
  }
}

TEST(SplineFunction, EnclosuresHoldWhatIsInABoxAndAreTight) {
  const SmoothDomain domain = make_spline_domain(noise({8, 8, 8}), {0, false});
  test::Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const Point3 p = random.in({{0, 0, 0}, {3, 5, 7}});
    const double width = std::pow(10, random.between(-6, 0.3));
    const IntervalBox box{{{p.x - width, p.x + width}, {p.y - width, p.y + width}, {p.z - width, p.z + width}}};
    Interval enclosures[20];
    if (!domain.function->enclose(box, 3, enclosures)) continue;
    double values[20];
    for (int sample = 0; sample < 20; ++sample) {
      const Point3 q = random.in({{box[0].low, box[1].low, box[2].low}, {box[0].high, box[1].high, box[2].high}});
      domain.function->evaluate(q, 3, values);
      for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_LE(enclosures[i].low, values[i]) << i;
        EXPECT_GE(enclosures[i].high, values[i]) << i;
      }
    }
    const double slope = std::abs(values[1]) + std::abs(values[2]) + std::abs(values[3]);
    if (width < 1e-3) {
      EXPECT_LE(enclosures[0].width(), 2 * width * (slope + 100 * width) + 1e-9);
    }
  }
}

TEST(SplineFunction, LiesInTheWorldAsTheImageDoes) {
  const PhantomOptions image = test::oblique_image();
  PhantomOptions small = image;
  small.dims = {24, 20, 12};
  const Volume volume = make_phantom("oblique-sphere", small);
  const SmoothDomain domain = make_spline_domain(volume, {phantom_truth("oblique-sphere", small).isovalue, false});
  const Vector3 spacing = volume.header().spacing();
  const Point3 at{3, 4, 5};
  EXPECT_LT(
      distance(domain.to_world({3 * spacing.x, 4 * spacing.y, 5 * spacing.z}), volume.header().index_to_world(at)),
      1e-9);
  EXPECT_NEAR(std::abs(domain.to_world.determinant()), 1, 1e-6);
}

TEST(SplineFunction, RefusesLargeAndShearedVolumes) {
  EXPECT_THROW(make_spline_domain(noise({33, 4, 4}), {0, false}), OptionError);
  EXPECT_NO_THROW(make_spline_domain(noise({32, 4, 4}), {0, false}));
  VolumeHeader sheared;
  sheared.dims = {4, 4, 4};
  sheared.index_to_world.rows[0][1] = 0.2;
  EXPECT_THROW(make_spline_domain(Volume(sheared, std::vector<float>(64, 1)), {0, false}), OptionError);
}

}  // namespace
}  // namespace delvox
