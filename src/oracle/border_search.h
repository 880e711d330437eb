#pragma once

#include <string>

#include "delvox/oracle/smooth_function.h"

namespace delvox {

/// Is a function above 0 all over the faces of a box?
struct BorderFinding {
  enum Kind { kOutside, kInside, kUndecided } kind = kOutside;
  Point3 place;  ///< where it is not, or may not be
};

/// Looks by subdivision down to `resolution` for a point where the function is at most 0; where intervals show that
/// there is none, not at all.
BorderFinding search_border(const SmoothFunction& function, const Box3& box, double resolution);

/// "1.5, 0, -2": for messages.
std::string place_text(const Point3& p);
/// What to tell of a domain that reaches the border of its box.
std::string inside_on_border(const Point3& place);

}  // namespace delvox
