#include "delvox/oracle/formula.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "delvox/core/errors.h"
#include "delvox/oracle/implicit_oracle.h"
#include "oracle/formula_algebra.h"
#include "oracle/formula_crossings.h"

namespace delvox {

/// A formula's text, and its program.
class Formula::Code {
 public:
  explicit Code(std::string text) : text_(std::move(text)), program_(compile_formula(parse_formula(text_), 1)) {}

  const std::string& text() const { return text_; }
  const FormulaProgram& program() const { return program_; }

 private:
  std::string text_;
  FormulaProgram program_;
};

Formula::Formula(std::string text) : code_(std::make_shared<const Code>(std::move(text))) {}

const std::string& Formula::text() const {
  return code_->text();
}

double Formula::value(const Point3& p) const {
  double value = 0;
  code_->program().evaluate(p, kFormulaResults[0], &value);
  return value;
}

Vector3 Formula::gradient(const Point3& p) const {
  std::array<double, kFormulaResults[1]> results;
  code_->program().evaluate(p, results.size(), results.data());
  return {results[1], results[2], results[3]};
}

namespace {

/// A point of the box's faces where the formula is at most 0, looked for by subdivision down to `resolution`; where
/// intervals show that there is none, not at all.
class BorderSearch {
 public:
  BorderSearch(const FormulaProgram& program, double resolution) : program_(program), resolution_(resolution) {}

  std::optional<Point3> on_faces_of(const Box3& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      for (double at : {box.min[axis], box.max[axis]}) {
        IntervalBox face{{{box.min.x, box.max.x}, {box.min.y, box.max.y}, {box.min.z, box.max.z}}};
        face[static_cast<std::size_t>(axis)] = at;
        if (const auto found = in(face)) return found;
      }
    }
    return std::nullopt;
  }

 private:
  std::optional<Point3> in(const IntervalBox& box) const {
    Interval enclosure;
    program_.enclose(box, 1, &enclosure);
    if (enclosure.low > 0) return std::nullopt;
    for (int corner = 0; corner < 9; ++corner) {
      Point3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Interval& side = box[axis];
        p[static_cast<int>(axis)] = corner == 8 ? side.middle() : (corner >> axis & 1) != 0 ? side.high : side.low;
      }
      double value = 0;
      program_.evaluate(p, 1, &value);
      if (value <= 0) return p;
    }
    const auto widest = std::max_element(box.begin(), box.end(),
                                         [](const Interval& a, const Interval& b) { return a.width() < b.width(); });
    if (widest->width() <= resolution_) return std::nullopt;
    for (const Interval& half : {Interval(widest->low, widest->middle()), Interval(widest->middle(), widest->high)}) {
      IntervalBox part = box;
      part[static_cast<std::size_t>(widest - box.begin())] = half;
      if (const auto found = in(part)) return found;
    }
    return std::nullopt;
  }

  const FormulaProgram& program_;
  double resolution_;
};

std::string text_of(const Point3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "%.4g, %.4g, %.4g", p.x, p.y, p.z);
  return text;
}

}  // namespace

std::unique_ptr<SmoothOracle> make_formula_oracle(const Formula& formula, const Box3& box, double resolution) {
  ImplicitFunction function;
  function.value = [formula](const Point3& p) { return formula.value(p); };
  function.gradient = [formula](const Point3& p) { return formula.gradient(p); };
  function.crossings = [formula, resolution](const Point3& a, const Point3& b) {
    return formula_crossings(formula.code_->program(), a, b, 0.25 * resolution);
  };
  function.box = box;
  function.resolution = resolution;
  check_function(function);
  if (const auto place = BorderSearch(formula.code_->program(), resolution).on_faces_of(box)) {
    throw OptionError("the formula is at most 0, that is inside, at " + text_of(*place) +
                      " on the border of the box: widen the box, cut the domain within it with max(formula, ...), or "
                      "turn the formula's sign if it is positive inside");
  }
  return make_implicit_oracle(function);
}

}  // namespace delvox
