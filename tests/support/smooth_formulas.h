#pragma once

#include "delvox/core/geometry.h"

namespace delvox::test {

// Formulas whose critical points and Voronoi faces are known, in a box that holds them.
inline const Box3 kBox{{-2, -2, -2}, {2, 2, 2}};
inline constexpr const char* kSphere = "x^2+y^2+z^2-1";
inline constexpr const char* kTorus = "(x^2+y^2+z^2+0.91)^2-4*(x^2+y^2)";  ///< radii 1 and 0.3
inline constexpr const char* kTwoSheets = "(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1.44)";

}  // namespace delvox::test
