#include "oracle/zero_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "delvox/oracle/interval_functions.h"

namespace delvox {
namespace {

/// A system by a function that fills values and Jacobian.
template <std::size_t N>
class System final : public ZeroSystem<N> {
 public:
  using Fill = std::function<void(const IntervalVector<N>&, IntervalVector<N>&, IntervalMatrix<N>&)>;
  explicit System(Fill fill) : fill_(std::move(fill)) {}
  bool enclose(const IntervalVector<N>& x, IntervalVector<N>& f, IntervalMatrix<N>& jacobian) const override {
    fill_(x, f, jacobian);
    return true;
  }

 private:
  Fill fill_;
};

const ZeroSearchLimits kFine{1e-9};

const System<2> kCircleAndLine([](const auto& x, auto& f, auto& j) {
  f = {power(x[0], 2) + power(x[1], 2) - Interval(1.0), x[0] - x[1]};
  j[0] = {Interval(2.0) * x[0], Interval(2.0) * x[1]};
  j[1] = {Interval(1.0), Interval(-1.0)};
});

/// sin x = 0, cos y = 0, z^2 = 2: 3 * 2 * 2 zeros in [-4, 4]^3.
const System<3> kGrid([](const auto& x, auto& f, auto& j) {
  f = {sin(x[0]), cos(x[1]), power(x[2], 2) - Interval(2.0)};
  j[0] = {cos(x[0]), Interval(0.0), Interval(0.0)};
  j[1] = {Interval(0.0), -sin(x[1]), Interval(0.0)};
  j[2] = {Interval(0.0), Interval(0.0), Interval(2.0) * x[2]};
});

template <std::size_t N>
bool holds(const IntervalVector<N>& box, const std::array<double, N>& point) {
  for (std::size_t i = 0; i < N; ++i) {
    if (!box[i].contains(point[i])) return false;
  }
  return true;
}

template <std::size_t N>
std::size_t count_holding(const Zeros<N>& zeros, const std::array<double, N>& point) {
  return static_cast<std::size_t>(
      std::count_if(zeros.simple.begin(), zeros.simple.end(), [&](const auto& box) { return holds<N>(box, point); }));
}

TEST(ZeroSearch, FindsEachZeroOnceInABoxThatHoldsIt) {
  const auto zeros = find_zeros<3>(kGrid, {{Interval(-4, 4), Interval(-4, 4), Interval(-4, 4)}}, kFine);
  EXPECT_TRUE(zeros.undecided.empty());
  // sin has -pi, 0, pi; cos has -3pi/2 (outside), -pi/2, pi/2.
  EXPECT_EQ(zeros.simple.size(), 3u * 2u * 2u);
  for (double x : {-std::numbers::pi, 0.0, std::numbers::pi}) {
    for (double y : {-std::numbers::pi / 2, std::numbers::pi / 2}) {
      for (double z : {-std::numbers::sqrt2, std::numbers::sqrt2}) EXPECT_EQ(count_holding<3>(zeros, {x, y, z}), 1u);
    }
  }
  for (const auto& box : zeros.simple) {
    for (const Interval& side : box) EXPECT_LT(side.width(), 1e-12);
  }
}

TEST(ZeroSearch, ZerosOnTheBordersOfBoxesAreFoundOnce) {
  // The zeros lie on the corners of the boxes that the search starts from, and of those it divides them into.
  const double h = std::numbers::sqrt2 / 2;
  std::vector<IntervalVector<2>> start;
  for (const Interval& x : {Interval(-2 * h, -h), Interval(-h, 0), Interval(0, h), Interval(h, 2 * h)}) {
    for (const Interval& y : {Interval(-2 * h, -h), Interval(-h, 0), Interval(0, h), Interval(h, 2 * h)}) {
      start.push_back({x, y});
    }
  }
  const auto zeros = find_zeros<2>(kCircleAndLine, start, kFine);
  EXPECT_TRUE(zeros.undecided.empty());
  EXPECT_EQ(zeros.simple.size(), 2u);
  EXPECT_EQ(count_holding<2>(zeros, {h, h}), 1u);
  EXPECT_EQ(count_holding<2>(zeros, {-h, -h}), 1u);
}

TEST(ZeroSearch, NoZeroIsKnownToBeNone) {
  const System<2> none([](const auto& x, auto& f, auto& j) {
    f = {power(x[0], 2) + power(x[1], 2) - Interval(1.0), x[0] - Interval(1.0001)};
    j[0] = {Interval(2.0) * x[0], Interval(2.0) * x[1]};
    j[1] = {Interval(1.0), Interval(0.0)};
  });
  const auto zeros = find_zeros<2>(none, {{Interval(-3, 3), Interval(-3, 3)}}, kFine);
  EXPECT_TRUE(zeros.simple.empty());
  EXPECT_TRUE(zeros.undecided.empty());
}

TEST(ZeroSearch, CloseZerosAreToldApart) {
  // (x - a)(x - b) with b - a = 1e-5.
  const System<1> pair([](const auto& x, auto& f, auto& j) {
    const Interval a(0.3), b(0.30001);
    f[0] = (x[0] - a) * (x[0] - b);
    j[0][0] = Interval(2.0) * x[0] - a - b;
  });
  const auto zeros = find_zeros<1>(pair, {{Interval(-1, 1)}}, kFine);
  EXPECT_TRUE(zeros.undecided.empty());
  EXPECT_EQ(zeros.simple.size(), 2u);
  EXPECT_EQ(count_holding<1>(zeros, {0.3}), 1u);
  EXPECT_EQ(count_holding<1>(zeros, {0.30001}), 1u);
}

TEST(ZeroSearch, DoubleZerosAreUndecidedNotLost) {
  const System<1> square([](const auto& x, auto& f, auto& j) {
    f[0] = power(x[0] - Interval(0.3), 2);
    j[0][0] = Interval(2.0) * (x[0] - Interval(0.3));
  });
  const auto zeros = find_zeros<1>(square, {{Interval(-1, 1)}}, {1e-6});
  EXPECT_TRUE(zeros.simple.empty());
  ASSERT_FALSE(zeros.undecided.empty());
  EXPECT_TRUE(std::any_of(zeros.undecided.begin(), zeros.undecided.end(),
                          [](const auto& box) { return box[0].contains(0.3); }));
  for (const auto& box : zeros.undecided) EXPECT_NEAR(box[0].middle(), 0.3, 1e-4);
}

TEST(ZeroSearch, WhatALimitCutsOffIsUndecided) {
  const auto zeros = find_zeros<3>(kGrid, {{Interval(-4, 4), Interval(-4, 4), Interval(-4, 4)}}, {1e-9, 20});
  for (double x : {-std::numbers::pi, 0.0, std::numbers::pi}) {
    const std::array<double, 3> zero{x, std::numbers::pi / 2, std::numbers::sqrt2};
    const bool undecided = std::any_of(zeros.undecided.begin(), zeros.undecided.end(),
                                       [&](const auto& box) { return holds<3>(box, zero); });
    EXPECT_TRUE(undecided || count_holding<3>(zeros, zero) == 1);
  }
}

TEST(ZeroSearch, EndsWithAsManyAsAreEnough) {
  const auto zeros = find_zeros<3>(kGrid, {{Interval(-4, 4), Interval(-4, 4), Interval(-4, 4)}}, {1e-9, 100'000, 1});
  EXPECT_EQ(zeros.simple.size(), 1u);
}

}  // namespace
}  // namespace delvox
