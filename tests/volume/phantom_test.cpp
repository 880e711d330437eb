#include "delvox/volume/phantom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

/// Visits n^3 points per voxel of the image, each standing for `weight` mm3.
template <typename Visit>
void for_each_subvoxel(const VolumeHeader& header, int n, Visit visit) {
  const double weight = std::abs(header.index_to_world.determinant()) / (n * n * n);
  for (int k = 0; k < n * header.dims[2]; ++k) {
    for (int j = 0; j < n * header.dims[1]; ++j) {
      for (int i = 0; i < n * header.dims[0]; ++i) {
        const Point3 index{(i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5, (k + 0.5) / n - 0.5};
        visit(header.index_to_world(index), weight);
      }
    }
  }
}

/// The voxels that are inside, with one layer of outside around them.
class Mask {
 public:
  Mask(const Volume& volume, double isovalue) {
    const auto samples = volume.samples();
    const auto dims = volume.dims();
    for (int axis = 0; axis < 3; ++axis) size_[axis] = dims[axis] + 2;
    inside_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2], false);
    std::size_t next = 0;
    for (int k = 0; k < dims[2]; ++k) {
      for (int j = 0; j < dims[1]; ++j) {
        for (int i = 0; i < dims[0]; ++i) inside_[index(i + 1, j + 1, k + 1)] = samples[next++] >= isovalue;
      }
    }
  }

  /// 6-connected pieces of the voxels that are (not) inside.
  int pieces(bool inside) const {
    std::vector<bool> seen(inside_.size(), false);
    int count = 0;
    for (std::size_t start = 0; start < inside_.size(); ++start) {
      if (inside_[start] != inside || seen[start]) continue;
      ++count;
      seen[start] = true;
      std::vector<std::size_t> stack{start};
      while (!stack.empty()) {
        const std::size_t at = stack.back();
        stack.pop_back();
        const std::size_t steps[3] = {1, static_cast<std::size_t>(size_[0]),
                                      static_cast<std::size_t>(size_[0]) * size_[1]};
        for (std::size_t step : steps) {
          for (std::size_t next : {at - step, at + step}) {  // at - step wraps round to a huge index
            if (next >= inside_.size() || seen[next] || inside_[next] != inside) continue;
            seen[next] = true;
            stack.push_back(next);
          }
        }
      }
    }
    return count;
  }

  /// Euler number of the body made of the inside voxels as closed cubes: vertices - edges + faces - cubes.
  int euler_of_body() const {
    int euler = 0;
    for (int k = 0; k + 1 < size_[2]; ++k) {
      for (int j = 0; j + 1 < size_[1]; ++j) {
        for (int i = 0; i + 1 < size_[0]; ++i) {
          for (int corner = 0; corner < 8; ++corner) {
            // The cell spanned by the voxels (i..i+dx, ...): a vertex for 3 directions, a cube for none.
            const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
            bool present = false;
            for (int c = 0; c <= dz; ++c) {
              for (int b = 0; b <= dy; ++b) {
                for (int a = 0; a <= dx; ++a) present = present || inside_[index(i + a, j + b, k + c)];
              }
            }
            if (present) euler += (dx + dy + dz) % 2 == 1 ? 1 : -1;
          }
        }
      }
    }
    return euler;
  }

 private:
  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i; }

  std::array<int, 3> size_;
  std::vector<bool> inside_;
};

TEST(Phantom, EveryKindOfTheIssueExistsAndIsDescribed) {
  std::set<std::string> names;
  for (const PhantomKind& kind : phantom_kinds()) {
    names.insert(kind.name);
    EXPECT_FALSE(kind.description.empty());
    EXPECT_EQ(kind.description.find('\n'), std::string::npos);
  }
  for (const char* name : {"sphere", "ellipsoid", "torus", "shells", "touching-balls", "plate", "rod", "gyroid",
                           "noisy-sphere", "oblique-sphere", "ramp", "random", "border", "shepp-logan"}) {
    EXPECT_TRUE(names.count(name)) << name;
  }
  EXPECT_EQ(names.size(), 14u);
}

TEST(Phantom, IsCenteredOnItsImage) {
  PhantomOptions options;
  options.dims = {10, 11, 12};
  options.spacing = {0.5, 1, 2};
  options.center = {1, 2, 3};
  const Volume volume = make_phantom("sphere", options);
  EXPECT_EQ(volume.dims(), options.dims);
  EXPECT_EQ(volume.header().frame, Frame::kRas);
  EXPECT_EQ(volume.header().orientation(), "RAS");
  EXPECT_EQ(volume.header().index_to_world({4.5, 5, 5.5}), options.center);
  EXPECT_EQ(volume.header().spacing(), options.spacing);
}

TEST(Phantom, SamplesAreTheExactFunctionAtVoxelCentersInWorldCoordinates) {
  for (const PhantomKind& kind : phantom_kinds()) {
    if (kind.name == "random" || kind.name == "noisy-sphere") continue;
    PhantomOptions options = phantom_defaults("oblique-sphere");
    options.dims = {25, 20, 15};
    const Volume volume = make_phantom(kind.name, options);
    const PhantomTruth truth = phantom_truth(kind.name, options);
    for (int k = 0; k < options.dims[2]; ++k) {
      for (int j = 0; j < options.dims[1]; ++j) {
        for (int i = 0; i < options.dims[0]; ++i) {
          // Written out, not by header().index_to_world: that is under test.
          Point3 world = options.center;
          const double offset[3] = {i - 12.0, j - 9.5, k - 7.0};
          for (int axis = 0; axis < 3; ++axis) {
            world = world + (offset[axis] * options.spacing[axis]) * options.direction[axis];
          }
          const double expected = truth.value(world);
          ASSERT_NEAR(volume.value(i, j, k), expected, 1e-6 * (1 + std::abs(expected))) << kind.name;
        }
      }
    }
  }
}

TEST(Phantom, ObliqueSphereSitsAtItsStatedCenterOffTheMiddle) {
  const PhantomOptions options = phantom_defaults("oblique-sphere");
  const Volume volume = make_phantom("oblique-sphere");
  const PhantomTruth truth = phantom_truth("oblique-sphere", options);
  EXPECT_NEAR(volume.header().index_to_world.determinant(), 0.7 * 0.9 * 1.6, 1e-12);
  EXPECT_GT(distance(*truth.center, options.center), 5.0);
  Point3 sum{};
  double weight = 0;
  for (int k = 0; k < options.dims[2]; ++k) {
    for (int j = 0; j < options.dims[1]; ++j) {
      for (int i = 0; i < options.dims[0]; ++i) {
        const double coverage = std::clamp(volume.value(i, j, k) + 0.5, 0.0, 1.0);
        sum = sum + coverage * volume.header().index_to_world({1.0 * i, 1.0 * j, 1.0 * k});
        weight += coverage;
      }
    }
  }
  EXPECT_LT(distance((1 / weight) * sum, *truth.center), 0.01);
  EXPECT_NEAR(weight * 0.7 * 0.9 * 1.6, *truth.volume_mm3, 0.002 * *truth.volume_mm3);
}

TEST(Phantom, StatedVolumesAgreeWithCountingSubvoxels) {
  int checked = 0;
  for (const PhantomKind& kind : phantom_kinds()) {
    PhantomOptions options = kind.defaults;
    for (int& n : options.dims) n /= 2;
    const PhantomTruth truth = phantom_truth(kind.name, options);
    if (!truth.value || !truth.volume_mm3) continue;
    double volume = 0;
    // Partial coverage where the gradient allows it: plain counting is off by 2 % on the thin rod. Its own bias on
    // the rod is (subvoxel / radius)^2 / 12: 0.15 % at 6 per voxel.
    const int subvoxels = kind.name == "rod" ? 6 : 2;
    for_each_subvoxel(make_phantom(kind.name, options).header(), subvoxels, [&](const Point3& p, double weight) {
      const double value = truth.value(p) - truth.isovalue;
      const double slope = truth.gradient ? norm(truth.gradient(p)) * std::cbrt(weight) : 0;
      volume += weight * (slope > 0 ? std::clamp(value / slope + 0.5, 0.0, 1.0) : value >= 0 ? 1.0 : 0.0);
    });
    // "border": the subvoxels of the closing slab follow the ball, the slab itself goes straight on.
    EXPECT_NEAR(volume, *truth.volume_mm3, (kind.name == "border" ? 0.015 : 0.003) * *truth.volume_mm3) << kind.name;
    ++checked;
  }
  EXPECT_EQ(checked, 13);
}

TEST(Phantom, StatedAreasAgreeWithTheCoareaFormula) {
  int checked = 0;
  for (const PhantomKind& kind : phantom_kinds()) {
    const PhantomTruth truth = phantom_truth(kind.name, kind.defaults);
    if (!truth.area_mm2) continue;
    const double half_width = 0.5 * kind.defaults.spacing.x;
    double area = 0;
    for_each_subvoxel(make_phantom(kind.name).header(), 3, [&](const Point3& p, double weight) {
      if (std::abs(truth.value(p)) < half_width) area += weight * norm(truth.gradient(p)) / (2 * half_width);
    });
    EXPECT_NEAR(area, *truth.area_mm2, 0.01 * *truth.area_mm2) << kind.name;
    ++checked;
  }
  EXPECT_EQ(checked, 8);
}

TEST(Phantom, StatedTopologyAgreesWithTheVoxels) {
  int checked = 0;
  for (const PhantomKind& kind : phantom_kinds()) {
    const PhantomTruth truth = phantom_truth(kind.name, kind.defaults);
    if (!truth.components) continue;
    const Mask mask(make_phantom(kind.name), truth.isovalue);
    const int bodies = mask.pieces(true), cavities = mask.pieces(false) - 1;
    EXPECT_EQ(bodies, *truth.bodies) << kind.name;
    EXPECT_EQ(bodies + cavities, *truth.components) << kind.name;
    EXPECT_EQ(2 * mask.euler_of_body(), *truth.euler) << kind.name;
    ++checked;
  }
  EXPECT_EQ(checked, 11);
}

TEST(Phantom, GradientsAreTheDerivativesOfTheValues) {
  for (const PhantomKind& kind : phantom_kinds()) {
    const PhantomTruth truth = phantom_truth(kind.name, kind.defaults);
    if (!truth.gradient) continue;
    const Affine3 affine = make_phantom(kind.name).header().index_to_world;
    int smooth = 0, wrong = 0;
    for (int n = 0; n < 2000; ++n) {
      // A golden-ratio walk through the image: no grid symmetry, no random generator.
      const auto part = [&](double step, int dims) { return std::fmod(n * step, 1.0) * (dims - 1); };
      const Point3 p = affine({part(0.8191725134, kind.defaults.dims[0]), part(0.6710436067, kind.defaults.dims[1]),
                               part(0.5497004779, kind.defaults.dims[2])});
      const Vector3 gradient = truth.gradient(p);
      bool agrees = true, kink = false;
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep = 1e-4;
        Point3 ahead = p, behind = p;
        ahead[axis] += kStep;
        behind[axis] -= kStep;
        const double forward = (truth.value(ahead) - truth.value(p)) / kStep;
        const double backward = (truth.value(p) - truth.value(behind)) / kStep;
        kink = kink || std::abs(forward - backward) > 1e-3;
        agrees = agrees && std::abs(0.5 * (forward + backward) - gradient[axis]) < 1e-3;
      }
      smooth += !kink;
      wrong += !kink && !agrees;
    }
    EXPECT_GT(smooth, 1900) << kind.name;
    EXPECT_EQ(wrong, 0) << kind.name;
  }
}

TEST(Phantom, RandomIntegersAreEvenlySpreadAndDependOnTheSeedOnly) {
  PhantomOptions options = phantom_defaults("random");
  const std::vector<float> samples = make_phantom("random", options).samples();
  std::array<int, 4> counts{};
  for (float sample : samples) {
    ASSERT_EQ(sample, std::floor(sample));
    ++counts.at(static_cast<std::size_t>(sample));
  }
  for (int count : counts) EXPECT_NEAR(count, samples.size() / 4.0, 4 * std::sqrt(samples.size() * 3.0 / 16));
  EXPECT_EQ(samples, make_phantom("random", options).samples());
  options.seed = 2;
  EXPECT_NE(samples, make_phantom("random", options).samples());
}

TEST(Phantom, NoiseHasTheStatedSpreadAndNoBias) {
  PhantomOptions options;
  const std::vector<float> clean = make_phantom("torus", options).samples();
  options.noise = 0.25;
  const std::vector<float> noisy = make_phantom("torus", options).samples();
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const double difference = noisy[i] - clean[i];
    sum += difference;
    squares += difference * difference;
  }
  const double count = static_cast<double>(clean.size());
  EXPECT_NEAR(sum / count, 0, 4 * 0.25 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.25, 0.002);
}

TEST(Phantom, NoisySphereHasSpecks) {
  EXPECT_GT(Mask(make_phantom("noisy-sphere"), 0).pieces(true), 100);
}

TEST(Phantom, RampIsExactInFloat) {
  const Volume volume = make_phantom("ramp");
  const PhantomTruth truth = phantom_truth("ramp", phantom_defaults("ramp"));
  for (int i = 0; i < 64; ++i) {
    const Point3 world = volume.header().index_to_world({1.0 * i, 63.0 - i, 1.0 * (i / 2)});
    EXPECT_EQ(volume.value(i, 63 - i, i / 2), truth.value(world));
  }
}

TEST(Phantom, BadOptionsAreRefusedWithTheMend) {
  EXPECT_THROW(make_phantom("banana"), OptionError);
  try {
    phantom_defaults("banana");
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("shepp-logan"), std::string::npos);
  }
  PhantomOptions options;
  options.dims = {0, 4, 4};
  EXPECT_THROW(make_phantom("sphere", options), OptionError);
  options.dims = {1000000, 1000000, 4};
  EXPECT_THROW(make_phantom("sphere", options), OptionError);
  options.dims = {100000, 100000, 4};  // can be streamed to a file, but not be held
  EXPECT_THROW(make_phantom("sphere", options), InputError);
  options = {};
  options.spacing.y = -1;
  EXPECT_THROW(make_phantom("sphere", options), OptionError);
  options = {};
  options.direction[0] = {1, 1, 0};
  EXPECT_THROW(make_phantom("sphere", options), OptionError);
  options = {};
  options.noise = std::nan("");
  EXPECT_THROW(make_phantom("sphere", options), OptionError);
}

}  // namespace
}  // namespace delvox
