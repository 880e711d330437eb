#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>

#include "delvox/oracle/interval_functions.h"
#include "delvox/oracle/smooth_function.h"

namespace delvox {

/// Enclosures of a function and of its derivatives up to `kOrder` (1 to 3), as SmoothFunction orders them. Arithmetic
/// on jets derives what is computed with them: Leibniz' rule for products, that of Faa di Bruno for functions of
/// functions (forward automatic differentiation: Griewank, Walther, Evaluating Derivatives, 2008).
template <int kOrder>
class Jet {
 public:
  static constexpr std::size_t kSize = SmoothFunction::kResults[kOrder];

  Jet(const Interval& value) { results_[0] = value; }  // NOLINT: a number is a constant function
  Jet(double value) : Jet(Interval(value)) {}          // NOLINT
  /// The coordinate along an axis.
  static Jet coordinate(const Interval& value, std::size_t axis) {
    Jet jet(value);
    jet.results_[1 + axis] = 1.0;
    return jet;
  }

  const std::array<Interval, kSize>& results() const { return results_; }

  friend Jet operator+(Jet a, const Jet& b) {
    for (std::size_t i = 0; i < kSize; ++i) a.results_[i] = a.results_[i] + b.results_[i];
    return a;
  }
  friend Jet operator-(Jet a, const Jet& b) {
    for (std::size_t i = 0; i < kSize; ++i) a.results_[i] = a.results_[i] - b.results_[i];
    return a;
  }
  friend Jet operator-(Jet a) {
    for (Interval& result : a.results_) result = -result;
    return a;
  }
  friend Jet operator*(const Jet& f, const Jet& g) {
    Jet product(f(0) * g(0));
    product.for_each_derivative(
        [&](std::size_t i) { return f(0) * g(1 + i) + f(1 + i) * g(0); },
        [&](std::size_t i, std::size_t j, std::size_t ij) {
          return f(0) * g(ij) + f(1 + i) * g(1 + j) + f(1 + j) * g(1 + i) + f(ij) * g(0);
        },
        [&](const std::array<std::size_t, 3>& axis, const std::array<std::size_t, 3>& others, std::size_t ijk) {
          Interval sum = f(0) * g(ijk) + f(ijk) * g(0);
          for (std::size_t n = 0; n < 3; ++n) sum = sum + f(1 + axis[n]) * g(others[n]) + f(others[n]) * g(1 + axis[n]);
          return sum;
        });
    return product;
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const Interval r = Interval(1.0) / b(0), rr = r * r;
    return a * b.through({r, -rr, Interval(2.0) * rr * r, Interval(-6.0) * rr * rr});
  }

  /// phi of this, for a phi whose value and first three derivatives at this are given.
  Jet through(const std::array<Interval, 4>& phi) const {
    const Jet& f = *this;
    Jet result(phi[0]);
    result.for_each_derivative(
        [&](std::size_t i) { return phi[1] * f(1 + i); },
        [&](std::size_t i, std::size_t j, std::size_t ij) { return phi[2] * f(1 + i) * f(1 + j) + phi[1] * f(ij); },
        [&](const std::array<std::size_t, 3>& axis, const std::array<std::size_t, 3>& others, std::size_t ijk) {
          Interval mixed = 0.0;
          for (std::size_t n = 0; n < 3; ++n) mixed = mixed + f(1 + axis[n]) * f(others[n]);
          return phi[3] * f(1 + axis[0]) * f(1 + axis[1]) * f(1 + axis[2]) + phi[2] * mixed + phi[1] * f(ijk);
        });
    return result;
  }
  const Interval& operator()(std::size_t i) const { return results_[i]; }

 private:
  static constexpr auto& kSecond = SmoothFunction::kSecond;

  /// Sets every derivative; `third` is given the axes, and for each of them the second derivative along the others.
  template <class First, class Second, class Third>
  void for_each_derivative(const First& first, const Second& second, const Third& third) {
    for (std::size_t i = 0; i < 3; ++i) results_[1 + i] = first(i);
    if constexpr (kOrder > 1) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) results_[kSecond[i][j]] = second(i, j, kSecond[i][j]);
      }
    }
    if constexpr (kOrder > 2) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) {
          for (std::size_t k = j; k < 3; ++k) {
            const std::size_t at = SmoothFunction::kThird[i][j][k];
            results_[at] = third({i, j, k}, {kSecond[j][k], kSecond[i][k], kSecond[i][j]}, at);
          }
        }
      }
    }
  }

  std::array<Interval, kSize> results_{};
};

/// a^n.
template <int kOrder>
Jet<kOrder> power(const Jet<kOrder>& a, int n) {
  const Interval& x = a(0);
  const auto derivative = [&](int order) {
    double factor = 1;
    for (int i = 0; i < order; ++i) factor *= n - i;
    return factor == 0 ? Interval(0.0) : Interval(factor) * power(x, n - order);
  };
  return a.through({derivative(0), derivative(1), derivative(2), derivative(3)});
}
/// Square root; nowhere smooth where its argument may be 0.
template <int kOrder>
Jet<kOrder> sqrt(const Jet<kOrder>& a) {
  const Interval root = sqrt(a(0)), r = Interval(1.0) / root, rr = r * r;
  return a.through({root, Interval(0.5) * r, Interval(-0.25) * rr * r, Interval(0.375) * rr * rr * r});
}
/// Exponential.
template <int kOrder>
Jet<kOrder> exp(const Jet<kOrder>& a) {
  const Interval e = exp(a(0));
  return a.through({e, e, e, e});
}
/// Natural logarithm.
template <int kOrder>
Jet<kOrder> log(const Jet<kOrder>& a) {
  const Interval r = Interval(1.0) / a(0), rr = r * r;
  return a.through({log(a(0)), r, -rr, Interval(2.0) * rr * r});
}
/// Sine.
template <int kOrder>
Jet<kOrder> sin(const Jet<kOrder>& a) {
  const Interval s = sin(a(0)), c = cos(a(0));
  return a.through({s, c, -s, -c});
}
/// Cosine.
template <int kOrder>
Jet<kOrder> cos(const Jet<kOrder>& a) {
  const Interval s = sin(a(0)), c = cos(a(0));
  return a.through({c, -s, -c, s});
}
/// Hyperbolic tangent.
template <int kOrder>
Jet<kOrder> tanh(const Jet<kOrder>& a) {
  const Interval t = tanh(a(0)), tt = power(t, 2), d = Interval(1.0) - tt;
  return a.through({t, d, Interval(-2.0) * t * d, Interval(2.0) * d * (Interval(3.0) * tt - Interval(1.0))});
}

/// A SmoothFunction from code: anything that can be called with three numbers, be they Interval or Jet, and uses
/// + - * / and the functions above, as `[](const auto& x, const auto& y, const auto& z) { return x * x + y * y + z * z
/// - 1.0; }`. There is no abs, min or max: they are not smooth.
template <class Callable>
class CallableFunction final : public SmoothFunction {
 public:
  explicit CallableFunction(Callable callable) : callable_(std::move(callable)) {}

  void evaluate(const Point3& p, int order, double* results) const override {
    std::array<Interval, kResults[3]> enclosures;
    enclose({Interval(p.x), Interval(p.y), Interval(p.z)}, order, enclosures.data());
    for (std::size_t i = 0; i < kResults[order]; ++i) results[i] = enclosures[i].middle();
  }
  bool enclose(const IntervalBox& box, int order, Interval* results) const override {
    switch (order) {
      case 0: *results = callable_(box[0], box[1], box[2]); return results->bounded();
      case 1: return enclose<1>(box, results);
      case 2: return enclose<2>(box, results);
      default: return enclose<3>(box, results);
    }
  }

 private:
  template <int kOrder>
  bool enclose(const IntervalBox& box, Interval* results) const {
    using Number = Jet<kOrder>;
    const Number jet =
        callable_(Number::coordinate(box[0], 0), Number::coordinate(box[1], 1), Number::coordinate(box[2], 2));
    std::copy(jet.results().begin(), jet.results().end(), results);
    return std::all_of(results, results + Number::kSize, [](const Interval& result) { return result.bounded(); });
  }

  Callable callable_;
};

/// See CallableFunction.
template <class Callable>
std::unique_ptr<SmoothFunction> make_smooth_function_of(Callable callable) {
  return std::make_unique<CallableFunction<Callable>>(std::move(callable));
}

}  // namespace delvox
