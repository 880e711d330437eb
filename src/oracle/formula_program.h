#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/oracle/interval.h"

namespace delvox {

/// One operation on results of earlier ones.
enum class FormulaOp : std::uint8_t {
  kX,
  kY,
  kZ,
  kConstant,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kNegate,
  kPower,        ///< to an integer
  kExponential,  ///< a^b of a > 0, b a constant or not
  kSqrt,
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
  kAbs,
  kSign,
  kStep,  ///< step: 1 for arguments from 0 on, else 0
  kMin,
  kMax
};

/// A function of x, y, z as a list of operations, each result computed once; the results asked for are among them.
/// Evaluated in doubles and in intervals.
class FormulaProgram {
 public:
  using Slot = std::uint32_t;
  struct Step {
    FormulaOp op;
    Slot a = 0, b = 0;
    int exponent = 0;
    double constant = 0;
  };

  /// Adds an operation, or finds it among those there are. Operands that commute are ordered by their structure, so
  /// that results do not depend on the order in which a formula's parts are added.
  Slot add(Step step);
  /// A number that depends on what a slot computes alone, not on the slot.
  std::uint64_t structure(Slot slot) const { return structures_[slot]; }
  const Step& step(Slot slot) const { return steps_[slot]; }
  void add_result(Slot slot) { results_.push_back(slot); }
  std::size_t size() const { return steps_.size(); }

  /// results[i] for the first `count` of what add_result was given.
  void evaluate(const Point3& p, std::size_t count, double* results) const;
  /// The same as enclosures over a box. False if the function may have a kink, jump or pole in it.
  bool enclose(const IntervalBox& box, std::size_t count, Interval* results) const;

 private:
  using Key = std::array<std::uint64_t, 3>;
  std::size_t length_for(std::size_t count) const;

  std::map<Key, Slot> numbers_;  // of the steps there are
  std::vector<Step> steps_;
  std::vector<std::uint64_t> structures_;
  std::vector<Slot> results_;
};

}  // namespace delvox
