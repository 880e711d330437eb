#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "delvox/oracle/interval.h"

namespace delvox {

template <std::size_t N>
using IntervalVector = std::array<Interval, N>;
template <std::size_t N>
using IntervalMatrix = std::array<IntervalVector<N>, N>;

/// N functions of N unknowns.
template <std::size_t N>
class ZeroSystem {
 public:
  virtual ~ZeroSystem() = default;
  /// Enclosures of the functions and of their Jacobian (a row for each function) over a box. False if the functions may
  /// not be smooth there.
  virtual bool enclose(const IntervalVector<N>& x, IntervalVector<N>& f, IntervalMatrix<N>& jacobian) const = 0;
  /// Does the box lie outside the region whose zeros are looked for?
  virtual bool outside(const IntervalVector<N>& x) const {
    (void)x;
    return false;
  }
};

/// When to give up.
struct ZeroSearchLimits {
  double smallest_width = 0;         ///< boxes down to it are not divided further
  std::size_t most_boxes = 100'000;  ///< nor is anything once so many have been looked at
  std::size_t enough = ~std::size_t{0};  ///< zeros: the search ends with these
};

/// Every zero lies in one of these boxes, unless there were `enough`.
template <std::size_t N>
struct Zeros {
  std::vector<IntervalVector<N>> simple;     ///< exactly one zero in each, its Jacobian regular
  std::vector<IntervalVector<N>> undecided;  ///< none, one or several zeros in each
};

/// All zeros in the boxes of `start`, by branch and bound with the interval Newton operator of Hansen and Sengupta,
/// preconditioned by the inverse of the middle Jacobian: for the mean value form F(y) + J(X)(X - y), y the middle of X,
/// the operator's image N(X) holds every zero of X; none if N(X) misses X, exactly one if N(X) lies in X's interior.
/// Operators act on boxes a little larger than those of the subdivision, so that zeros on their borders are decided
/// too. Zeros slightly outside `start` may be among those found.
/// Source: Neumaier, Interval Methods for Systems of Equations (1990), sections 5.1 and 5.2.
template <std::size_t N>
Zeros<N> find_zeros(const ZeroSystem<N>& system, const std::vector<IntervalVector<N>>& start,
                    const ZeroSearchLimits& limits);

}  // namespace delvox
