#pragma once

#include <cmath>
#include <limits>

namespace delvox {

/// A root of f in [a, b] by the Illinois variant of the secant method, with a bisection whenever that stops gaining.
/// Returns the argument with the smallest |f| met. pre: fa = f(a) and fb = f(b) have different signs (0 counts as <= 0).
/// Stops when f is down to rounding noise of `scale` or the bracket to rounding noise of its ends.
template <class Function>
double bracketed_root(const Function& f, double a, double fa, double b, double fb, double scale) {
  const double noise = 2 * std::numeric_limits<double>::epsilon() * scale;
  double best = std::abs(fa) < std::abs(fb) ? a : b;
  double best_value = std::min(std::abs(fa), std::abs(fb));
  double weight_a = fa, weight_b = fb;
  int stays = 0;  // which end has stayed last: -1 a, 1 b. Illinois halves the weight of one that stays twice in a row
  for (int iteration = 0; iteration < 100 && best_value > noise; ++iteration) {
    const bool bisect = iteration % 4 == 3;
    double t = bisect ? 0.5 * (a + b) : (a * weight_b - b * weight_a) / (weight_b - weight_a);
    if (!(t > std::min(a, b) && t < std::max(a, b))) t = 0.5 * (a + b);
    if (t == a || t == b) break;
    const double ft = f(t);
    if (std::abs(ft) < best_value) {
      best_value = std::abs(ft);
      best = t;
    }
    if ((ft > 0) == (fa > 0)) {
      a = t;
      fa = weight_a = ft;
      if (stays == 1) weight_b *= 0.5;
      stays = 1;
    } else {
      b = t;
      fb = weight_b = ft;
      if (stays == -1) weight_a *= 0.5;
      stays = -1;
    }
  }
  return best;
}

}  // namespace delvox
