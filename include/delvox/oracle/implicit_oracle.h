#pragma once

#include <functional>
#include <memory>

#include "delvox/oracle/oracle.h"

namespace delvox {

/// A domain {h <= 0} inside a box, given by a function and its gradient (world coordinates, mm).
struct ImplicitFunction {
  std::function<double(const Point3&)> value;      ///< negative inside, as is usual; NaN is outside
  std::function<Vector3(const Point3&)> gradient;  ///< of value
  Box3 box;                                        ///< the zero set lies strictly inside it
  /// Features of the surface (components, gaps) thinner than this may be missed by seeds and intersect_all, mm.
  double resolution = 0;
  /// Where along ab, as shares of it, every change of sign lies, in order; null: looked for in steps of a quarter of
  /// the resolution. The segment lies in the box.
  std::function<std::vector<double>(const Point3& a, const Point3& b)> crossings = {};
};

/// Throws OptionError if the box is empty or narrower than the resolution, or if the resolution is not positive.
void check_function(const ImplicitFunction& function);

/// Throws OptionError as check_function does, NothingToMesh if the function changes sign on no grid edge of that
/// resolution.
std::unique_ptr<SmoothOracle> make_implicit_oracle(const ImplicitFunction& function);

}  // namespace delvox
