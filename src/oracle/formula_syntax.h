#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace delvox {

/// What a formula may call.
enum class FormulaCall {
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kSinh,
  kCosh,
  kTanh,
  kExp,
  kLog,
  kSqrt,
  kAbs,
  kMin,
  kMax
};

/// A formula as it was written: a tree of operations.
struct FormulaNode {
  enum class Kind { kNumber, kX, kY, kZ, kSum, kProduct, kNegate, kInverse, kPower, kCall };
  Kind kind = Kind::kNumber;
  double number = 0;
  FormulaCall call = FormulaCall::kSin;
  std::vector<FormulaNode> operands;  ///< of sums, products, min and max two or more; what is subtracted is negated
  std::size_t position = 0;           ///< in the text, from 0
};

/// Reads a formula in x, y, z: + - * / ^, brackets, numbers, pi, e and the functions above; ^ binds tighter than a sign
/// before it and is right-associative, as usual in mathematics.
/// Throws OptionError that names the position, from 1, and what stands there.
FormulaNode parse_formula(std::string_view text);

/// "at position 5, '+)'": for messages.
std::string formula_place(std::string_view text, std::size_t position);

}  // namespace delvox
