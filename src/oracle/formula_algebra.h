#pragma once

#include "oracle/formula_program.h"
#include "oracle/formula_syntax.h"

namespace delvox {

/// The program of a formula and of its partial derivatives up to `order` (0 to 3), in the order of
/// SmoothFunction::kResults.
/// Throws OptionError if the formula is not real, divides by zero, or its derivatives grow beyond all measure.
FormulaProgram compile_formula(const FormulaNode& formula, int order);

}  // namespace delvox
