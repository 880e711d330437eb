#pragma once

#include <memory>
#include <string>

#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"
#include "delvox/oracle/smooth_function.h"

namespace delvox {

/// A real function of x, y, z, as it is written in mathematics: "x^2 + y^2 + z^2 - 1". There are + - * / ^, brackets,
/// numbers, pi, e, and sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt, abs, min, max. Derivatives
/// are symbolic; evaluation is compiled, thread-safe, and NaN where the formula is undefined.
class Formula {
 public:
  /// Throws OptionError that names the position if the text does not parse, or if it is no real function.
  explicit Formula(std::string text);

  const std::string& text() const;
  double value(const Point3& p) const;
  Vector3 gradient(const Point3& p) const;

 private:
  friend std::unique_ptr<SmoothOracle> make_formula_oracle(const Formula&, const Box3&, double);
  class Code;
  std::shared_ptr<const Code> code_;
};

/// The domain where a formula is at most 0, inside a box (mm). Components and gaps of the surface thinner than
/// `resolution` may be missed by seeds.
/// Throws OptionError if the box is empty or narrower than the resolution, if the resolution is not positive, or if the
/// domain reaches the box: its surface would end there. Throws NothingToMesh if the formula is at most 0 nowhere that a
/// grid of that resolution looks.
std::unique_ptr<SmoothOracle> make_formula_oracle(const Formula& formula, const Box3& box, double resolution);

/// The formula with its derivatives up to the third, and their enclosures. Throws OptionError if they grow too long.
std::unique_ptr<SmoothFunction> make_smooth_function(const Formula& formula);

}  // namespace delvox
