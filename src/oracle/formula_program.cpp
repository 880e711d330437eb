#include "oracle/formula_program.h"

#include <bit>

#include "core/hash.h"
#include "delvox/oracle/interval_functions.h"

namespace delvox {
namespace {

using Step = FormulaProgram::Step;

bool commutes(FormulaOp op) {
  return op == FormulaOp::kAdd || op == FormulaOp::kMultiply || op == FormulaOp::kMin || op == FormulaOp::kMax;
}
bool has_operand(FormulaOp op) {
  return op >= FormulaOp::kAdd;
}
bool has_two_operands(FormulaOp op) {
  return op == FormulaOp::kSubtract || op == FormulaOp::kDivide || op == FormulaOp::kExponential || commutes(op);
}

double apply(const Step& step, const double* r, const Point3& p) {
  const double a = r[step.a], b = r[step.b];
  switch (step.op) {
    case FormulaOp::kX: return p.x;
    case FormulaOp::kY: return p.y;
    case FormulaOp::kZ: return p.z;
    case FormulaOp::kConstant: return step.constant;
    case FormulaOp::kAdd: return a + b;
    case FormulaOp::kSubtract: return a - b;
    case FormulaOp::kMultiply: return a * b;
    case FormulaOp::kDivide: return a / b;
    case FormulaOp::kNegate: return -a;
    case FormulaOp::kPower:
      return step.exponent == 2 ? a * a : step.exponent == 3 ? a * a * a : std::pow(a, step.exponent);
    case FormulaOp::kExponential: return std::pow(a, b);
    case FormulaOp::kSqrt: return std::sqrt(a);
    case FormulaOp::kSin: return std::sin(a);
    case FormulaOp::kCos: return std::cos(a);
    case FormulaOp::kTan: return std::tan(a);
    case FormulaOp::kAsin: return std::asin(a);
    case FormulaOp::kAcos: return std::acos(a);
    case FormulaOp::kAtan: return std::atan(a);
    case FormulaOp::kSinh: return std::sinh(a);
    case FormulaOp::kCosh: return std::cosh(a);
    case FormulaOp::kTanh: return std::tanh(a);
    case FormulaOp::kExp: return std::exp(a);
    case FormulaOp::kLog: return std::log(a);
    case FormulaOp::kAbs: return std::abs(a);
    case FormulaOp::kSign: return a > 0 ? 1 : a < 0 ? -1 : 0;
    case FormulaOp::kStep: return a >= 0 ? 1 : 0;
    case FormulaOp::kMin: return b < a ? b : a;
    case FormulaOp::kMax: return a < b ? b : a;
  }
  return 0;
}

/// Numbers that are no small integers may stand for ones that no double is.
Interval constant(double value) {
  const bool exact = value == std::floor(value) && std::abs(value) < 0x1p53;
  return exact ? Interval(value) : widened(value, value, 4);
}

Interval apply(const Step& step, const Interval* r, const IntervalBox& box, bool& smooth) {
  const Interval &a = r[step.a], &b = r[step.b];
  switch (step.op) {
    case FormulaOp::kX: return box[0];
    case FormulaOp::kY: return box[1];
    case FormulaOp::kZ: return box[2];
    case FormulaOp::kConstant: return constant(step.constant);
    case FormulaOp::kAdd: return a + b;
    case FormulaOp::kSubtract: return a - b;
    case FormulaOp::kMultiply: return step.a == step.b ? power(a, 2) : a * b;
    case FormulaOp::kDivide: smooth &= !b.contains_zero(); return a / b;
    case FormulaOp::kNegate: return -a;
    case FormulaOp::kPower: smooth &= step.exponent >= 0 || !a.contains_zero(); return power(a, step.exponent);
    case FormulaOp::kExponential: smooth &= a.low > 0; return exponential(a, b);
    case FormulaOp::kSqrt: smooth &= a.low > 0; return sqrt(a);
    case FormulaOp::kSin: return sin(a);
    case FormulaOp::kCos: return cos(a);
    case FormulaOp::kTan: {
      const Interval result = tan(a);
      smooth &= result.bounded();
      return result;
    }
    case FormulaOp::kAsin: smooth &= a.low > -1 && a.high < 1; return asin(a);
    case FormulaOp::kAcos: smooth &= a.low > -1 && a.high < 1; return acos(a);
    case FormulaOp::kAtan: return atan(a);
    case FormulaOp::kSinh: return sinh(a);
    case FormulaOp::kCosh: return cosh(a);
    case FormulaOp::kTanh: return tanh(a);
    case FormulaOp::kExp: return exp(a);
    case FormulaOp::kLog: smooth &= a.low > 0; return log(a);
    case FormulaOp::kAbs: smooth &= !a.contains_zero(); return abs(a);
    case FormulaOp::kSign:
      smooth &= !a.contains_zero();
      return {a.low > 0 ? 1.0 : a.low < 0 ? -1.0 : 0.0, a.high > 0 ? 1.0 : a.high < 0 ? -1.0 : 0.0};
    case FormulaOp::kStep: smooth &= !a.contains_zero(); return {a.low >= 0 ? 1.0 : 0.0, a.high >= 0 ? 1.0 : 0.0};
    case FormulaOp::kMin: smooth &= disjoint(a, b); return min(a, b);
    case FormulaOp::kMax: smooth &= disjoint(a, b); return max(a, b);
  }
  return Interval::all();
}

/// Room for results of steps, kept between evaluations.
template <class T>
T* scratch(std::size_t size) {
  thread_local std::vector<T> room;
  if (room.size() < size) room.resize(size);
  return room.data();
}

}  // namespace

FormulaProgram::Slot FormulaProgram::add(Step step) {
  if (commutes(step.op) && structures_[step.b] < structures_[step.a]) std::swap(step.a, step.b);
  const auto bits = std::bit_cast<std::uint64_t>(step.constant);
  const auto head = static_cast<std::uint64_t>(step.op) << 32 | static_cast<std::uint32_t>(step.exponent);
  const auto [found, is_new] = numbers_.try_emplace(Key{head, bits, static_cast<std::uint64_t>(step.a) << 32 | step.b},
                                                    static_cast<Slot>(steps_.size()));
  if (!is_new) return found->second;
  std::uint64_t structure = mix_hash(mix_hash(head) ^ bits);
  if (has_operand(step.op)) structure = mix_hash(structure ^ structures_[step.a]);
  if (has_two_operands(step.op)) structure = mix_hash(structure + structures_[step.b]);
  steps_.push_back(step);
  structures_.push_back(structure);
  return found->second;
}

std::size_t FormulaProgram::length_for(std::size_t count) const {
  return *std::max_element(results_.begin(), results_.begin() + static_cast<std::ptrdiff_t>(count)) + std::size_t{1};
}

void FormulaProgram::evaluate(const Point3& p, std::size_t count, double* results) const {
  const std::size_t length = length_for(count);
  double* room = scratch<double>(length);
  for (std::size_t i = 0; i < length; ++i) room[i] = apply(steps_[i], room, p);
  for (std::size_t i = 0; i < count; ++i) results[i] = room[results_[i]];
}

bool FormulaProgram::enclose(const IntervalBox& box, std::size_t count, Interval* results) const {
  const std::size_t length = length_for(count);
  Interval* room = scratch<Interval>(length);
  bool smooth = true;
  for (std::size_t i = 0; i < length; ++i) room[i] = apply(steps_[i], room, box, smooth);
  for (std::size_t i = 0; i < count; ++i) results[i] = room[results_[i]];
  return smooth;
}

}  // namespace delvox
