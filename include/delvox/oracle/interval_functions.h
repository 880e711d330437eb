#pragma once

#include "delvox/oracle/interval.h"

namespace delvox {

// Elementary functions of intervals, widened by more than the C library's are ever off (some ulp). Arguments outside a
// function's domain give Interval::all().

Interval sqrt(const Interval& a);
Interval exp(const Interval& a);
Interval log(const Interval& a);
Interval sin(const Interval& a);
Interval cos(const Interval& a);
Interval tan(const Interval& a);
Interval asin(const Interval& a);
Interval acos(const Interval& a);
Interval atan(const Interval& a);
Interval sinh(const Interval& a);
Interval cosh(const Interval& a);
Interval tanh(const Interval& a);
Interval abs(const Interval& a);
/// a^b of a > 0.
Interval exponential(const Interval& a, const Interval& b);

}  // namespace delvox
