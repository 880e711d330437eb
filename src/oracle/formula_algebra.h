#pragma once

#include "oracle/formula_program.h"
#include "oracle/formula_syntax.h"

namespace delvox {

/// Results of the program of a formula: its value, first, second and third partial derivatives.
inline constexpr std::size_t kFormulaResults[] = {1, 4, 10, 20};

/// The program of a formula and of its partial derivatives up to `order` (0 to 3), in the order
/// value, x, y, z, xx, xy, xz, yy, yz, zz, xxx, xxy, xxz, xyy, xyz, xzz, yyy, yyz, yzz, zzz.
/// Throws OptionError if the formula is not real, divides by zero, or its derivatives grow beyond all measure.
FormulaProgram compile_formula(const FormulaNode& formula, int order);

}  // namespace delvox
