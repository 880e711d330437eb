// The one file that knows GiNaC: a formula's derivatives, and from GiNaC's expressions to the steps of a program.
//
// GiNaC orders the terms of sums and products by addresses, so by chance; add_terms and multiply order them again, by
// what they compute. Its numbers are doubles here, exponents too: powers of exact integers can be too long to hold, and
// sums to exact powers are made primitive, with signs that depend on that order.
#include "oracle/formula_algebra.h"

#include <ginac/ginac.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "delvox/core/errors.h"

namespace delvox {
namespace {

using GiNaC::ex;
using GiNaC::exvector;
using Slot = FormulaProgram::Slot;

// What GiNaC has no real version of. Derivatives hold away from kinks.
DECLARE_FUNCTION_2P(delvox_min)
DECLARE_FUNCTION_2P(delvox_max)
DECLARE_FUNCTION_1P(delvox_abs)
DECLARE_FUNCTION_1P(delvox_sign)
DECLARE_FUNCTION_1P(delvox_step)

ex derivative_of_min(const ex& a, const ex& b, unsigned parameter) {
  return parameter == 0 ? 1 - delvox_step(a - b) : ex(delvox_step(a - b));
}
ex derivative_of_max(const ex& a, const ex& b, unsigned parameter) {
  return parameter == 0 ? ex(delvox_step(a - b)) : 1 - delvox_step(a - b);
}
ex derivative_of_abs(const ex& a, unsigned) {
  return delvox_sign(a);
}
ex derivative_of_piecewise_constant(const ex&, unsigned) {
  return 0;
}

REGISTER_FUNCTION(delvox_min, derivative_func(derivative_of_min))
REGISTER_FUNCTION(delvox_max, derivative_func(derivative_of_max))
REGISTER_FUNCTION(delvox_abs, derivative_func(derivative_of_abs))
REGISTER_FUNCTION(delvox_sign, derivative_func(derivative_of_piecewise_constant))
REGISTER_FUNCTION(delvox_step, derivative_func(derivative_of_piecewise_constant))

/// More steps than that are no formula that anyone meant.
constexpr std::size_t kMostSteps = 1'000'000;

const std::map<std::string, FormulaOp>& functions() {
  static const std::map<std::string, FormulaOp> table = {
      {"sin", FormulaOp::kSin},          {"cos", FormulaOp::kCos},          {"tan", FormulaOp::kTan},
      {"asin", FormulaOp::kAsin},        {"acos", FormulaOp::kAcos},        {"atan", FormulaOp::kAtan},
      {"sinh", FormulaOp::kSinh},        {"cosh", FormulaOp::kCosh},        {"tanh", FormulaOp::kTanh},
      {"exp", FormulaOp::kExp},          {"log", FormulaOp::kLog},          {"delvox_abs", FormulaOp::kAbs},
      {"delvox_sign", FormulaOp::kSign}, {"delvox_step", FormulaOp::kStep}, {"delvox_min", FormulaOp::kMin},
      {"delvox_max", FormulaOp::kMax}};
  return table;
}

ex apply(FormulaCall call, const ex& a) {
  switch (call) {
    case FormulaCall::kSin: return GiNaC::sin(a);
    case FormulaCall::kCos: return GiNaC::cos(a);
    case FormulaCall::kTan: return GiNaC::tan(a);
    case FormulaCall::kAsin: return GiNaC::asin(a);
    case FormulaCall::kAcos: return GiNaC::acos(a);
    case FormulaCall::kAtan: return GiNaC::atan(a);
    case FormulaCall::kSinh: return GiNaC::sinh(a);
    case FormulaCall::kCosh: return GiNaC::cosh(a);
    case FormulaCall::kTanh: return GiNaC::tanh(a);
    case FormulaCall::kExp: return GiNaC::exp(a);
    case FormulaCall::kLog: return GiNaC::log(a);
    case FormulaCall::kSqrt: return GiNaC::pow(a, GiNaC::numeric(0.5));
    default: return delvox_abs(a);
  }
}

/// From the tree as written to GiNaC.
class Translation {
 public:
  explicit Translation(const std::array<GiNaC::realsymbol, 3>& symbols) : symbols_(symbols) {}

  ex operator()(const FormulaNode& node) const {
    exvector operands;
    for (const FormulaNode& operand : node.operands) operands.push_back((*this)(operand));
    switch (node.kind) {
      case FormulaNode::Kind::kNumber: return GiNaC::numeric(node.number);
      case FormulaNode::Kind::kX: return symbols_[0];
      case FormulaNode::Kind::kY: return symbols_[1];
      case FormulaNode::Kind::kZ: return symbols_[2];
      case FormulaNode::Kind::kSum: return GiNaC::add(operands);
      case FormulaNode::Kind::kProduct: return GiNaC::mul(operands);
      case FormulaNode::Kind::kNegate: return -operands[0];
      case FormulaNode::Kind::kInverse: return GiNaC::pow(operands[0], GiNaC::numeric(-1.0));
      case FormulaNode::Kind::kPower: return GiNaC::pow(operands[0], operands[1]);
      case FormulaNode::Kind::kCall: break;
    }
    if (node.call != FormulaCall::kMin && node.call != FormulaCall::kMax) return apply(node.call, operands[0]);
    ex result = operands[0];
    for (std::size_t i = 1; i < operands.size(); ++i) {
      result =
          node.call == FormulaCall::kMin ? ex(delvox_min(result, operands[i])) : ex(delvox_max(result, operands[i]));
    }
    return result;
  }

 private:
  const std::array<GiNaC::realsymbol, 3>& symbols_;
};

/// From GiNaC to steps.
class Compilation {
 public:
  Compilation(const std::array<GiNaC::realsymbol, 3>& symbols, FormulaProgram& program) : program_(program) {
    for (int axis = 0; axis < 3; ++axis) {
      slots_.emplace(symbols[axis], add({static_cast<FormulaOp>(static_cast<int>(FormulaOp::kX) + axis)}));
    }
  }

  Slot operator()(const ex& e) {
    if (const auto known = slots_.find(e); known != slots_.end()) return known->second;
    const Slot slot = compile(e);
    slots_.emplace(e, slot);
    return slot;
  }

 private:
  Slot add(const FormulaProgram::Step& step) {
    if (program_.size() > kMostSteps) throw OptionError("the formula's derivatives are too long; simplify it");
    return program_.add(step);
  }
  Slot constant(double value) { return add({FormulaOp::kConstant, 0, 0, 0, value}); }

  static double real(const ex& e) {
    const ex number = e.evalf();
    const bool is_real = GiNaC::is_exactly_a<GiNaC::numeric>(number) && GiNaC::ex_to<GiNaC::numeric>(number).is_real();
    const double value = is_real ? GiNaC::ex_to<GiNaC::numeric>(number).to_double() : NAN;
    if (!std::isfinite(value)) {
      throw OptionError("the formula has a part that is no real number, such as the root of a negative one");
    }
    return value;
  }

  Slot compile(const ex& e) {
    if (GiNaC::is_a<GiNaC::numeric>(e) || GiNaC::is_a<GiNaC::constant>(e)) return constant(real(e));
    if (GiNaC::is_a<GiNaC::add>(e)) return add_terms(e);
    if (GiNaC::is_a<GiNaC::mul>(e)) return multiply(e);
    if (GiNaC::is_a<GiNaC::power>(e)) return power(e.op(0), e.op(1));
    if (GiNaC::is_a<GiNaC::function>(e)) {
      const auto known = functions().find(GiNaC::ex_to<GiNaC::function>(e).get_name());
      if (known != functions().end()) {
        const Slot a = (*this)(e.op(0));
        return add({known->second, a, e.nops() > 1 ? (*this)(e.op(1)) : 0});
      }
    }
    throw OptionError("the formula has a part that cannot be computed: it is undefined, or infinite");
  }

  Slot add_terms(const ex& sum) {
    struct Term {
      double factor;
      Slot rest;
    };
    std::vector<Term> terms;
    for (const ex& term : sum) {
      const auto [factor, rest] = split(term);
      terms.push_back({factor, (*this)(rest)});
    }
    std::sort(terms.begin(), terms.end(), [this](const Term& a, const Term& b) {
      return std::pair(program_.structure(a.rest), a.factor) < std::pair(program_.structure(b.rest), b.factor);
    });
    std::optional<Slot> total;
    for (const Term& term : terms) {
      const double size = std::abs(term.factor);
      const Slot part = size == 1 ? term.rest : add({FormulaOp::kMultiply, constant(size), term.rest});
      if (total) {
        total = add({term.factor < 0 ? FormulaOp::kSubtract : FormulaOp::kAdd, *total, part});
      } else {
        total = term.factor < 0 ? add({FormulaOp::kNegate, part}) : part;
      }
    }
    return *total;
  }

  /// A term as a number and the rest of it.
  static std::pair<double, ex> split(const ex& term) {
    if (GiNaC::is_a<GiNaC::numeric>(term)) return {real(term), 1};
    if (!GiNaC::is_a<GiNaC::mul>(term)) return {1, term};
    double factor = 1;
    exvector rest;
    for (const ex& part : term) {
      if (GiNaC::is_a<GiNaC::numeric>(part)) {
        factor *= real(part);
      } else {
        rest.push_back(part);
      }
    }
    return {factor, GiNaC::mul(rest)};
  }

  Slot multiply(const ex& product) {
    double factor = 1;
    std::vector<Slot> above, below;
    for (const ex& part : product) {
      const bool is_number = GiNaC::is_a<GiNaC::numeric>(part);
      if (is_number) {
        factor *= real(part);
      } else if (GiNaC::is_a<GiNaC::power>(part) && GiNaC::is_a<GiNaC::numeric>(part.op(1)) && real(part.op(1)) < 0) {
        below.push_back(power(part.op(0), -real(part.op(1))));
      } else {
        above.push_back((*this)(part));
      }
    }
    if (factor != 1 || above.empty()) above.push_back(constant(factor));
    const Slot numerator = product_of(above);
    return below.empty() ? numerator : add({FormulaOp::kDivide, numerator, product_of(below)});
  }

  Slot product_of(std::vector<Slot>& factors) {
    std::sort(factors.begin(), factors.end(),
              [this](Slot a, Slot b) { return program_.structure(a) < program_.structure(b); });
    Slot product = factors[0];
    for (std::size_t i = 1; i < factors.size(); ++i) product = add({FormulaOp::kMultiply, product, factors[i]});
    return product;
  }

  Slot power(const ex& base, const ex& exponent) {
    if (GiNaC::is_a<GiNaC::numeric>(exponent)) return power(base, real(exponent));
    const Slot a = (*this)(base);
    return add({FormulaOp::kExponential, a, (*this)(exponent)});
  }

  Slot power(const ex& base, double exponent) {
    if (exponent < 0) return add({FormulaOp::kDivide, constant(1), power(base, -exponent)});
    Slot a = (*this)(base);
    if (exponent == 1) return a;
    constexpr double kLargest = 1e9;
    const bool whole = exponent == std::floor(exponent), half = 2 * exponent == std::floor(2 * exponent);
    if (!half || exponent > kLargest) return add({FormulaOp::kExponential, a, constant(exponent)});
    if (!whole) a = add({FormulaOp::kSqrt, a});
    const int n = static_cast<int>(whole ? exponent : 2 * exponent);
    return n == 1 ? a : add({FormulaOp::kPower, a, 0, n});
  }

  FormulaProgram& program_;
  std::map<ex, Slot, GiNaC::ex_is_less> slots_;
};

FormulaProgram compile(const FormulaNode& formula, int order) {
  const std::array<GiNaC::realsymbol, 3> symbols{GiNaC::realsymbol("x"), GiNaC::realsymbol("y"),
                                                 GiNaC::realsymbol("z")};
  FormulaProgram program;
  Compilation compile(symbols, program);
  struct Derivative {
    ex value;
    std::size_t last_axis;
  };
  std::vector<Derivative> level{{Translation(symbols)(formula), 0}};
  program.add_result(compile(level[0].value));
  for (int i = 0; i < order; ++i) {
    std::vector<Derivative> next;
    for (const Derivative& d : level) {
      for (std::size_t axis = d.last_axis; axis < 3; ++axis) {
        next.push_back({d.value.diff(symbols[axis]), axis});
        program.add_result(compile(next.back().value));
      }
    }
    level = std::move(next);
  }
  return program;
}

}  // namespace

FormulaProgram compile_formula(const FormulaNode& formula, int order) {
  static std::mutex one_at_a_time;  // GiNaC counts references without locks
  const std::lock_guard lock(one_at_a_time);
  try {
    return compile(formula, order);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // GiNaC's own, about poles and overflow
    throw OptionError("the formula makes no sense: " + std::string(error.what()));
  }
}

}  // namespace delvox
