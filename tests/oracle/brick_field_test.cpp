#include "oracle/brick_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"
#include "support/shapes.h"

namespace delvox {
namespace {

/// The padded grid as one dense array, interpolated by the formula of the textbooks.
class NaiveField {
 public:
  NaiveField(const Volume& volume, const LevelSet& level_set) : level_(level_set.level) {
    for (int axis = 0; axis < 3; ++axis) size_[axis] = volume.dims()[axis] + 2;
    samples_.resize(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]);
    copy_padded_block(volume, level_set, {-1, -1, -1}, size_, samples_.data());
  }

  double sample(int i, int j, int k) const {
    return samples_[(static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i];
  }
  double value(const Point3& u) const {
    int low[3];
    for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(static_cast<int>(std::floor(u[axis])), size_[axis] - 2);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      int at[3];
      for (int axis = 0; axis < 3; ++axis) {
        const int up = corner >> axis & 1;
        at[axis] = low[axis] + up;
        weight *= up ? u[axis] - low[axis] : low[axis] + 1 - u[axis];
      }
      sum += weight * sample(at[0], at[1], at[2]);
    }
    return sum - level_;
  }
  const std::array<int, 3>& size() const { return size_; }

 private:
  std::array<int, 3> size_;
  std::vector<float> samples_;
  double level_;
};

Volume volume_of(const std::array<int, 3>& dims, const std::function<float(int, int, int)>& sample) {
  VolumeHeader header;
  header.dims = dims;
  std::vector<float> samples;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) samples.push_back(sample(i, j, k));
    }
  }
  return Volume(header, samples);
}

void expect_agreement(const Volume& volume, const Isosurface& surface) {
  const LevelSet level_set(surface);
  const BrickField field(volume, level_set);
  const NaiveField naive(volume, level_set);
  ASSERT_EQ(field.size(), naive.size());
  const Box3 box{{0, 0, 0}, {naive.size()[0] - 1.0, naive.size()[1] - 1.0, naive.size()[2] - 1.0}};
  const double scale = std::max(std::abs(volume.min()), std::abs(volume.max())) + std::abs(surface.isovalue);
  test::Random random(1);
  for (int n = 0; n < 20000; ++n) {
    Point3 u = random.in(box);
    // Also points on grid planes, lines and samples, where two or more bricks meet.
    for (int axis = 0; axis < 3; ++axis) {
      if (random.below(4) == 0) u[axis] = std::round(u[axis]);
    }
    ASSERT_TRUE(field.contains(u));
    const double expected = naive.value(u);
    if (field.in_mixed_brick(u)) {
      ASSERT_NEAR(field.value(u), expected, 1e-14 * scale);
    }
    if (std::abs(expected) > 1e-14 * scale) {
      ASSERT_EQ(field.inside(u), expected > 0);
    }
    const std::array<int, 3> cell = field.cell_of(u);
    int inside = 0;
    for (int corner = 0; corner < 8; ++corner) {
      inside += naive.sample(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2)) > field.level();
    }
    ASSERT_EQ(field.cell_state(cell), inside == 0   ? BrickField::State::kOutside
                                      : inside == 8 ? BrickField::State::kInside
                                                    : BrickField::State::kMixed);
  }
}

TEST(BrickField, EqualsNaiveTrilinearInterpolationOnRandomVolumesOfAwkwardSizes) {
  test::Random random(2);
  for (const std::array<int, 3>& dims :
       {std::array{1, 1, 1}, {2, 1, 3}, {6, 7, 8}, {7, 14, 15}, {16, 17, 5}, {37, 20, 11}}) {
    const Volume volume = volume_of(dims, [&](int, int, int) { return static_cast<float>(random.between(-3, 5)); });
    expect_agreement(volume, {0.7, false});
    expect_agreement(volume, {0.7, true});
  }
}

TEST(BrickField, EqualsNaiveTrilinearInterpolationWhereMostBricksArePure) {
  expect_agreement(make_phantom("shells", test::cubic_image(45)), {0, false});
  expect_agreement(make_phantom("gyroid", test::cubic_image(41)), {0.3, true});
}

TEST(BrickField, TellsWhichBoxesHaveMixedCells) {
  const Volume volume = make_phantom("shells", test::cubic_image(45));
  const BrickField field(volume, LevelSet({0, false}));
  test::Random random(3);
  std::array<int, 2> counts{};
  for (int n = 0; n < 20000; ++n) {
    std::array<int, 3> a, b, cell;
    bool wide = false;
    for (int axis = 0; axis < 3; ++axis) {
      const int last = field.size()[axis] - 2;
      a[axis] = random.below(last + 1);
      b[axis] = std::clamp(a[axis] + random.below(n % 10 == 0 ? 25 : 7) - (n % 10 == 0 ? 12 : 3), 0, last);
      wide |= std::abs(a[axis] - b[axis]) > BrickField::kBrick;
    }
    bool mixed = wide;
    for (cell[2] = std::min(a[2], b[2]); cell[2] <= std::max(a[2], b[2]) && !mixed; ++cell[2]) {
      for (cell[1] = std::min(a[1], b[1]); cell[1] <= std::max(a[1], b[1]); ++cell[1]) {
        for (cell[0] = std::min(a[0], b[0]); cell[0] <= std::max(a[0], b[0]); ++cell[0]) {
          mixed |= field.cell_state(cell) == BrickField::State::kMixed;
        }
      }
    }
    ASSERT_EQ(field.may_be_mixed(a, b), mixed);
    ++counts[mixed];
  }
  EXPECT_GT(std::min(counts[0], counts[1]), 2000);
}

TEST(BrickField, IsContinuousAcrossBrickFaces) {
  const Volume volume = make_phantom("gyroid", test::cubic_image(40));
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  test::Random random(3);
  int tested = 0;
  for (int n = 0; n < 20000; ++n) {
    Point3 u = random.in({{1, 1, 1}, {39, 39, 39}});
    const int axis = random.below(3);
    u[axis] = BrickField::kBrick * (1 + random.below(4));
    Point3 before = u, after = u;
    before[axis] -= 1e-9;
    after[axis] += 1e-9;
    if (!field.in_mixed_brick(before) || !field.in_mixed_brick(after)) continue;
    ++tested;
    ASSERT_NEAR(field.value(before), field.value(after), 1e-8);
  }
  EXPECT_GT(tested, 1000);
}

TEST(BrickField, PureBricksAreThoseWithoutTheSurface) {
  const Volume volume = make_phantom("sphere", test::cubic_image(45));
  const LevelSet level_set(Isosurface{0, false});
  const BrickField field(volume, level_set);
  const NaiveField naive(volume, level_set);
  int pure = 0;
  const auto& counts = field.brick_counts();
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        int inside = 0, all = 0;
        for (int n = 0; n < BrickField::kBlockSize; ++n) {
          const int at[3] = {8 * i + n % 9, 8 * j + n / 9 % 9, 8 * k + n / 81};
          if (at[0] >= naive.size()[0] || at[1] >= naive.size()[1] || at[2] >= naive.size()[2]) continue;
          ++all;
          inside += naive.sample(at[0], at[1], at[2]) > level_set.level;
        }
        const auto expected = inside == 0     ? BrickField::State::kOutside
                              : inside == all ? BrickField::State::kInside
                                              : BrickField::State::kMixed;
        ASSERT_EQ(field.state({i, j, k}), expected);
        pure += expected != BrickField::State::kMixed;
      }
    }
  }
  EXPECT_GT(pure, 50);
}

TEST(BrickField, GradientIsTheDerivativeInsideCells) {
  test::Random random(4);
  const Volume volume =
      volume_of({12, 11, 10}, [&](int, int, int) { return static_cast<float>(random.between(-1, 1)); });
  const BrickField field(volume, LevelSet(Isosurface{0, false}));
  for (int n = 0; n < 2000; ++n) {
    Point3 u;
    for (int axis = 0; axis < 3; ++axis) u[axis] = random.below(field.size()[axis] - 1) + random.between(0.01, 0.99);
    if (!field.in_mixed_brick(u)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      Point3 ahead = u, behind = u;
      ahead[axis] += 0.005;
      behind[axis] -= 0.005;
      // Linear along each axis, so differences are exact.
      ASSERT_NEAR(field.gradient(u)[axis], (field.value(ahead) - field.value(behind)) / 0.01, 1e-12);
    }
  }
}

}  // namespace
}  // namespace delvox
