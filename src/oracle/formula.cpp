#include "delvox/oracle/formula.h"

#include <array>

#include "delvox/core/errors.h"
#include "delvox/oracle/implicit_oracle.h"
#include "oracle/border_search.h"
#include "oracle/formula_algebra.h"
#include "oracle/formula_crossings.h"

namespace delvox {
namespace {

class FormulaFunction final : public SmoothFunction {
 public:
  /// With derivatives up to `order`.
  FormulaFunction(const std::string& text, int order) : program_(compile_formula(parse_formula(text), order)) {}

  void evaluate(const Point3& p, int order, double* results) const override {
    program_.evaluate(p, kResults[order], results);
  }
  bool enclose(const IntervalBox& box, int order, Interval* results) const override {
    return program_.enclose(box, kResults[order], results);
  }

 private:
  FormulaProgram program_;
};

}  // namespace

/// A formula's text, and the function, with its gradient.
class Formula::Code {
 public:
  explicit Code(std::string text) : text_(std::move(text)), function_(text_, 1) {}

  const std::string& text() const { return text_; }
  const SmoothFunction& function() const { return function_; }

 private:
  std::string text_;
  FormulaFunction function_;
};

Formula::Formula(std::string text) : code_(std::make_shared<const Code>(std::move(text))) {}

const std::string& Formula::text() const {
  return code_->text();
}

double Formula::value(const Point3& p) const {
  double value = 0;
  code_->function().evaluate(p, 0, &value);
  return value;
}

Vector3 Formula::gradient(const Point3& p) const {
  std::array<double, SmoothFunction::kResults[1]> results;
  code_->function().evaluate(p, 1, results.data());
  return {results[1], results[2], results[3]};
}

std::unique_ptr<SmoothOracle> make_formula_oracle(const Formula& formula, const Box3& box, double resolution) {
  ImplicitFunction function;
  function.value = [formula](const Point3& p) { return formula.value(p); };
  function.gradient = [formula](const Point3& p) { return formula.gradient(p); };
  function.crossings = [formula, resolution](const Point3& a, const Point3& b) {
    return formula_crossings(formula.code_->function(), a, b, 0.25 * resolution);
  };
  function.box = box;
  function.resolution = resolution;
  check_function(function);
  const BorderFinding border = search_border(formula.code_->function(), box, resolution);
  if (border.kind == BorderFinding::kInside) throw OptionError(inside_on_border(border.place));
  return make_implicit_oracle(function);
}

std::unique_ptr<SmoothFunction> make_smooth_function(const Formula& formula) {
  return std::make_unique<FormulaFunction>(formula.text(), 3);
}

}  // namespace delvox
