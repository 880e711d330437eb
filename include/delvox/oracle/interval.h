#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace delvox {

/// All numbers from low to high. Operations return an interval that holds every result on members of their arguments:
/// results are rounded to nearest, then widened by what that can have lost (Rump, Zimmermann, Boldo, Melquiond,
/// Computing predecessor and successor in rounding to nearest, 2009). Where a result is undefined or its bounds are no
/// numbers, it is all().
struct Interval {
  double low = 0, high = 0;

  Interval() = default;
  Interval(double value) : low(value), high(value) {}  // NOLINT: a number is an interval
  Interval(double from, double to) : low(from), high(to) {}
  static Interval all() { return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}; }

  bool contains(double value) const { return low <= value && value <= high; }
  bool contains_zero() const { return low <= 0 && high >= 0; }
  bool bounded() const { return std::isfinite(low) && std::isfinite(high); }
  double width() const { return high - low; }
  double middle() const { return 0.5 * low + 0.5 * high; }
  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
};

/// [low, high] with an error of rounding on either side, of `ulps` units in the last place.
inline Interval widened(double low, double high, double ulps = 1) {
  constexpr double kHalfUlp = 0x1p-53 * (1 + 0x1p-52), kTiny = std::numeric_limits<double>::denorm_min();
  if (!(low <= high)) return Interval::all();
  return {low - (ulps * kHalfUlp * std::abs(low) + kTiny), high + (ulps * kHalfUlp * std::abs(high) + kTiny)};
}

inline Interval operator-(const Interval& a) {
  return {-a.high, -a.low};
}
inline Interval operator+(const Interval& a, const Interval& b) {
  return widened(a.low + b.low, a.high + b.high);
}
inline Interval operator-(const Interval& a, const Interval& b) {
  return widened(a.low - b.high, a.high - b.low);
}

inline Interval operator*(const Interval& a, const Interval& b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  if (!std::isfinite(std::abs(p) + std::abs(q) + std::abs(r) + std::abs(s))) {
    if ((a.low == 0 && a.high == 0) || (b.low == 0 && b.high == 0)) return 0.0;
    return Interval::all();
  }
  return widened(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

inline Interval operator/(const Interval& a, const Interval& b) {
  if (b.contains_zero()) return Interval::all();
  return a * widened(1 / b.high, 1 / b.low);
}

/// a^n; for even n never below 0.
inline Interval power(const Interval& a, int n) {
  if (n == 0) return 1.0;
  if (n < 0) return Interval(1.0) / power(a, -n);
  if (n == 1) return a;
  const bool even = n % 2 == 0;
  const double low = std::pow(a.low, n), high = std::pow(a.high, n);
  if (!even || a.low >= 0) {
    Interval result = widened(low, high, 4);
    if (even) result.low = std::max(result.low, 0.0);
    return result;
  }
  if (a.high <= 0) return {std::max(0.0, widened(high, low, 4).low), widened(high, low, 4).high};
  return {0.0, widened(0, std::max(low, high), 4).high};
}

inline Interval min(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::min(a.high, b.high)};
}
inline Interval max(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::max(a.high, b.high)};
}

/// The numbers in both. pre: there are some.
inline Interval intersection(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}
inline bool disjoint(const Interval& a, const Interval& b) {
  return a.high < b.low || b.high < a.low;
}

/// All points whose coordinates are in three intervals.
using IntervalBox = std::array<Interval, 3>;

}  // namespace delvox
