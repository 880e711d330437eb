#pragma once

#include "delvox/oracle/interval.h"

namespace delvox {

// Elementary functions of intervals, widened by more than the C library's are ever off (some ulp). Arguments outside a
// function's domain give Interval::all().

/// Holds the square root of every member.
Interval sqrt(const Interval& a);
/// Holds exp of every member.
Interval exp(const Interval& a);
/// Holds the natural logarithm of every member.
Interval log(const Interval& a);
/// Holds sin of every member.
Interval sin(const Interval& a);
/// Holds cos of every member.
Interval cos(const Interval& a);
/// Holds tan of every member.
Interval tan(const Interval& a);
/// Holds asin of every member.
Interval asin(const Interval& a);
/// Holds acos of every member.
Interval acos(const Interval& a);
/// Holds atan of every member.
Interval atan(const Interval& a);
/// Holds sinh of every member.
Interval sinh(const Interval& a);
/// Holds cosh of every member.
Interval cosh(const Interval& a);
/// Holds tanh of every member.
Interval tanh(const Interval& a);
/// Holds the absolute value of every member.
Interval abs(const Interval& a);
/// a^b of a > 0.
Interval exponential(const Interval& a, const Interval& b);

}  // namespace delvox
