#include "delvox/oracle/interval_functions.h"

#include <numbers>

namespace delvox {
namespace {

constexpr double kUlps = 8, kPi = std::numbers::pi;
/// Beyond it, multiples of pi are no longer known well enough.
constexpr double kLargestAngle = 1e6;

template <class Function>
Interval increasing(const Interval& a, const Function& f) {
  return widened(f(a.low), f(a.high), kUlps);
}

/// May the interval hold offset + k period for a whole k?
bool may_hold(const Interval& a, double offset, double period) {
  constexpr double kDoubt = 1e-9;
  return std::floor((a.high - offset) / period + kDoubt) >= std::ceil((a.low - offset) / period - kDoubt);
}

/// Below 0 by no more than products of zeros are widened by.
bool hardly_negative(double value) {
  return value >= -1e-300;
}

}  // namespace

Interval sqrt(const Interval& a) {
  if (!hardly_negative(a.low)) return Interval::all();
  const Interval result =
      increasing({std::max(a.low, 0.0), std::max(a.high, 0.0)}, [](double x) { return std::sqrt(x); });
  return {std::max(result.low, 0.0), result.high};
}

Interval exp(const Interval& a) {
  const Interval result = increasing(a, [](double x) { return std::exp(x); });
  return {std::max(result.low, 0.0), result.high};
}

Interval log(const Interval& a) {
  if (!hardly_negative(a.low) || a.high <= 0) return Interval::all();
  return increasing({std::max(a.low, 0.0), a.high}, [](double x) { return std::log(x); });
}

Interval sin(const Interval& a) {
  if (!(a.magnitude() < kLargestAngle) || a.width() >= 2 * kPi) return {-1, 1};
  const double p = std::sin(a.low), q = std::sin(a.high);
  Interval result = widened(std::min(p, q), std::max(p, q), kUlps);
  if (may_hold(a, kPi / 2, 2 * kPi)) result.high = 1;
  if (may_hold(a, -kPi / 2, 2 * kPi)) result.low = -1;
  return {std::max(result.low, -1.0), std::min(result.high, 1.0)};
}

Interval cos(const Interval& a) {
  return sin(a + widened(kPi / 2, kPi / 2));
}

Interval tan(const Interval& a) {
  if (!(a.magnitude() < kLargestAngle) || a.width() >= kPi || may_hold(a, kPi / 2, kPi)) return Interval::all();
  return increasing(a, [](double x) { return std::tan(x); });
}

Interval asin(const Interval& a) {
  if (a.low < -1 || a.high > 1) return Interval::all();
  return increasing(a, [](double x) { return std::asin(x); });
}

Interval acos(const Interval& a) {
  if (a.low < -1 || a.high > 1) return Interval::all();
  return -increasing(a, [](double x) { return -std::acos(x); });
}

Interval atan(const Interval& a) {
  return increasing(a, [](double x) { return std::atan(x); });
}

Interval sinh(const Interval& a) {
  return increasing(a, [](double x) { return std::sinh(x); });
}

Interval cosh(const Interval& a) {
  const Interval size = abs(a);
  return increasing(size, [](double x) { return std::cosh(x); });
}

Interval tanh(const Interval& a) {
  return increasing(a, [](double x) { return std::tanh(x); });
}

Interval abs(const Interval& a) {
  if (a.contains_zero()) return {0, a.magnitude()};
  return {std::min(std::abs(a.low), std::abs(a.high)), a.magnitude()};
}

Interval exponential(const Interval& a, const Interval& b) {
  if (!(a.low > 0)) return Interval::all();
  return exp(b * log(a));
}

}  // namespace delvox
