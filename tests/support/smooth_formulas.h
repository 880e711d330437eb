#pragma once

#include <memory>

#include "delvox/core/geometry.h"
#include "delvox/oracle/formula.h"
#include "delvox/oracle/smooth_function.h"

namespace delvox::test {

// Formulas whose critical points and Voronoi faces are known, in a box that holds them.
inline const Box3 kBox{{-2, -2, -2}, {2, 2, 2}};
inline constexpr const char* kSphere = "x^2+y^2+z^2-1";
inline constexpr const char* kTorus = "(x^2+y^2+z^2+0.91)^2-4*(x^2+y^2)";  ///< radii 1 and 0.3
inline constexpr const char* kTwoSheets = "(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1.44)";

/// A function whose second and third derivatives are hardly known.
class Loose final : public SmoothFunction {
 public:
  explicit Loose(const char* formula) : function_(make_smooth_function(Formula(formula))) {}
  void evaluate(const Point3& p, int order, double* results) const override { function_->evaluate(p, order, results); }
  bool enclose(const IntervalBox& box, int order, Interval* results) const override {
    const bool smooth = function_->enclose(box, order, results);
    for (std::size_t i = kResults[1]; i < kResults[order]; ++i) results[i] = {-1e4, 1e4};
    return smooth;
  }

 private:
  std::unique_ptr<SmoothFunction> function_;
};

}  // namespace delvox::test
