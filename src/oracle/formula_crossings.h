#pragma once

#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/oracle/smooth_function.h"

namespace delvox {

/// Where along the segment ab a formula becomes positive or ceases to be, as shares of it, in order. The segment is
/// bisected until intervals show that the formula has one sign along a piece, or rises or falls along all of it, so
/// that none is missed: but where pieces of 2^-44 of the segment do not tell, as along a tangent, the signs at a
/// piece's ends decide, and where the formula is undefined, or next to 0 along whole stretches, those at steps of
/// `coarse` mm.
std::vector<double> formula_crossings(const SmoothFunction& function, const Point3& a, const Point3& b, double coarse);

}  // namespace delvox
