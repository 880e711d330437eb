#include "oracle/zero_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace delvox {
namespace {

template <std::size_t N>
using Matrix = std::array<std::array<double, N>, N>;

/// By Gauss and Jordan with pivots; none if it is singular or nearly.
template <std::size_t N>
std::optional<Matrix<N>> inverse_of_middle(const IntervalMatrix<N>& jacobian) {
  Matrix<N> a, inverse{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) a[i][j] = jacobian[i][j].middle();
    inverse[i][i] = 1;
  }
  for (std::size_t column = 0; column < N; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column + 1; i < N; ++i) {
      if (std::abs(a[i][column]) > std::abs(a[pivot][column])) pivot = i;
    }
    std::swap(a[pivot], a[column]);
    std::swap(inverse[pivot], inverse[column]);
    const double factor = 1 / a[column][column];
    if (!std::isfinite(factor)) return std::nullopt;
    for (std::size_t j = 0; j < N; ++j) a[column][j] *= factor, inverse[column][j] *= factor;
    for (std::size_t i = 0; i < N; ++i) {
      const double multiple = a[i][column];
      if (i == column || multiple == 0) continue;
      for (std::size_t j = 0; j < N; ++j) {
        a[i][j] -= multiple * a[column][j];
        inverse[i][j] -= multiple * inverse[column][j];
      }
    }
  }
  return inverse;
}

template <std::size_t N>
double largest_width(const IntervalVector<N>& x) {
  double width = 0;
  for (const Interval& side : x) width = std::max(width, side.width());
  return width;
}

template <std::size_t N>
IntervalVector<N> middle_of(const IntervalVector<N>& x) {
  IntervalVector<N> middle;
  for (std::size_t i = 0; i < N; ++i) middle[i] = x[i].middle();
  return middle;
}

template <std::size_t N>
bool overlap(const IntervalVector<N>& a, const IntervalVector<N>& b) {
  for (std::size_t i = 0; i < N; ++i) {
    if (disjoint(a[i], b[i])) return false;
  }
  return true;
}

/// x reduced to what is in both. False if nothing is.
template <std::size_t N>
bool reduce(IntervalVector<N>& x, const IntervalVector<N>& by) {
  if (!overlap(x, by)) return false;
  for (std::size_t i = 0; i < N; ++i) x[i] = intersection(x[i], by[i]);
  return true;
}

enum class Verdict { kNone, kUnique, kOpen };

template <std::size_t N>
class ZeroSearch {
 public:
  ZeroSearch(const ZeroSystem<N>& system, const ZeroSearchLimits& limits) : system_(system), limits_(limits) {}

  Zeros<N> run(const std::vector<IntervalVector<N>>& start) {
    waiting_.assign(start.rbegin(), start.rend());
    while (!waiting_.empty() && zeros_.simple.size() < limits_.enough) {
      IntervalVector<N> x = waiting_.back();
      waiting_.pop_back();
      look_at(x);
    }
    return std::move(zeros_);
  }

 private:
  void look_at(IntervalVector<N> x) {
    if (system_.outside(x)) return;
    const bool in_known = std::any_of(known_.begin(), known_.end(), [&](const IntervalVector<N>& known) {
      for (std::size_t i = 0; i < N; ++i) {
        if (x[i].low < known[i].low || x[i].high > known[i].high) return false;
      }
      return true;
    });
    if (in_known) return;  // its only zero has been found
    if (++boxes_ > limits_.most_boxes) {
      zeros_.undecided.push_back(x);
      return;
    }
    IntervalVector<N> larger = inflated(x);
    const IntervalVector<N> region = larger;
    const Verdict verdict = contract(larger);
    if (verdict == Verdict::kNone) return;
    if (verdict == Verdict::kUnique) {
      known_.push_back(region);
      keep(larger);
      return;
    }
    const double before = largest_width(x);
    if (!reduce(x, larger)) return;
    constexpr double kGoodReduction = 0.6;
    if (before <= limits_.smallest_width) {
      zeros_.undecided.push_back(x);
    } else if (largest_width(x) < kGoodReduction * before) {
      waiting_.push_back(x);
    } else {
      divide(x);
    }
  }

  static IntervalVector<N> inflated(const IntervalVector<N>& x) {
    constexpr double kShare = 0.05;
    const double margin = kShare * largest_width(x);
    IntervalVector<N> larger;
    for (std::size_t i = 0; i < N; ++i) larger[i] = {x[i].low - margin, x[i].high + margin};
    return larger;
  }

  void divide(const IntervalVector<N>& x) {
    std::size_t widest = 0;
    for (std::size_t i = 1; i < N; ++i) {
      if (x[i].width() > x[widest].width()) widest = i;
    }
    for (const Interval& half :
         {Interval(x[widest].middle(), x[widest].high), Interval(x[widest].low, x[widest].middle())}) {
      IntervalVector<N> part = x;
      part[widest] = half;
      waiting_.push_back(part);
    }
  }

  /// One step of the operator: x becomes what it leaves of x.
  Verdict contract(IntervalVector<N>& x) const {
    IntervalVector<N> f, f_middle;
    IntervalMatrix<N> jacobian, unused;
    const bool smooth = system_.enclose(x, f, jacobian);
    for (const Interval& value : f) {
      if (!value.contains_zero()) return Verdict::kNone;
    }
    if (!smooth) return Verdict::kOpen;
    const IntervalVector<N> y = middle_of(x);
    system_.enclose(y, f_middle, unused);
    for (std::size_t i = 0; i < N; ++i) {
      Interval mean_value = f_middle[i];
      for (std::size_t j = 0; j < N; ++j) mean_value = mean_value + jacobian[i][j] * (x[j] - y[j]);
      if (!mean_value.contains_zero()) return Verdict::kNone;
    }
    const auto inverse = inverse_of_middle<N>(jacobian);
    return inverse ? sweep(x, y, *inverse, f_middle, jacobian) : Verdict::kOpen;
  }

  /// Gauss and Seidel's sweep over the preconditioned system.
  static Verdict sweep(IntervalVector<N>& x, const IntervalVector<N>& y, const Matrix<N>& inverse,
                       const IntervalVector<N>& f_middle, const IntervalMatrix<N>& jacobian) {
    bool inside = true;
    for (std::size_t i = 0; i < N; ++i) {
      Interval shift = 0.0, diagonal = 0.0;
      for (std::size_t k = 0; k < N; ++k) shift = shift + Interval(inverse[i][k]) * f_middle[k];
      for (std::size_t j = 0; j < N; ++j) {
        Interval entry = 0.0;
        for (std::size_t k = 0; k < N; ++k) entry = entry + Interval(inverse[i][k]) * jacobian[k][j];
        if (j == i) {
          diagonal = entry;
        } else {
          shift = shift + entry * (x[j] - y[j]);
        }
      }
      if (diagonal.contains_zero() || !diagonal.bounded()) {
        inside = false;
        continue;
      }
      const Interval image = y[i] - shift / diagonal;
      if (disjoint(image, x[i])) return Verdict::kNone;
      inside = inside && image.low > x[i].low && image.high < x[i].high;
      x[i] = intersection(x[i], image);
    }
    return inside ? Verdict::kUnique : Verdict::kOpen;
  }

  /// A box with one zero, made as small as it gets; unless the zero is known.
  void keep(IntervalVector<N> x) {
    for (int step = 0; step < 20; ++step) {
      const double before = largest_width(x);
      IntervalVector<N> smaller = x;
      if (contract(smaller) == Verdict::kNone || !(largest_width(smaller) < 0.9 * before)) break;
      x = smaller;
    }
    const bool known = std::any_of(zeros_.simple.begin(), zeros_.simple.end(),
                                   [&](const IntervalVector<N>& other) { return overlap(x, other); });
    if (!known && !system_.outside(x)) zeros_.simple.push_back(x);
  }

  const ZeroSystem<N>& system_;
  const ZeroSearchLimits& limits_;
  Zeros<N> zeros_;
  std::vector<IntervalVector<N>> waiting_, known_;  // known_: boxes whose only zero has been found
  std::size_t boxes_ = 0;
};

}  // namespace

template <std::size_t N>
Zeros<N> find_zeros(const ZeroSystem<N>& system, const std::vector<IntervalVector<N>>& start,
                    const ZeroSearchLimits& limits) {
  return ZeroSearch<N>(system, limits).run(start);
}

template Zeros<1> find_zeros(const ZeroSystem<1>&, const std::vector<IntervalVector<1>>&, const ZeroSearchLimits&);
template Zeros<2> find_zeros(const ZeroSystem<2>&, const std::vector<IntervalVector<2>>&, const ZeroSearchLimits&);
template Zeros<3> find_zeros(const ZeroSystem<3>&, const std::vector<IntervalVector<3>>&, const ZeroSearchLimits&);

}  // namespace delvox
