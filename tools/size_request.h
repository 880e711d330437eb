#pragma once

#include <optional>
#include <string>

#include "delvox/core/size_field.h"
#include "delvox/oracle/formula.h"
#include "delvox/oracle/oracle.h"
#include "patient_frame.h"

namespace delvox::tools {

/// What --size asks for: a number, the name of a volume file, a formula in x, y, z, or a length that the surface itself
/// has, `lfs` or `curvature`; the last three are known once there is a surface.
class SizeRequest {
 public:
  /// `frame`: that of the input, which size volumes are turned to. Throws OptionError, InputError.
  SizeRequest(const std::string& text, Frame frame);

  /// The field, if it needs no surface.
  const std::optional<SizeField>& field() const { return field_; }
  /// Whether it is a share, --epsilon, of a length of the surface.
  bool of_surface() const { return kind_ == Kind::kFeature || kind_ == Kind::kCurvature; }

  /// The field on a surface, looked at at points `spacing` apart. A share of the surface's length is not below that
  /// share of two spacings, which is as far as points can tell it. Formulas are in the output frame, which `frame`
  /// leads to; they are held within what they are at points of the surface and of the inside. Throws OptionError if the
  /// surface has no such length, or a formula is not positive, what throw_if_cancelled does.
  SizeField on(const Oracle& oracle, double spacing, double epsilon, const FrameChange& frame) const;
  /// A bound on circumradii of tets that goes with it: at the surface the same, and growing inward as the distance.
  SizeField cells_on(const Oracle& oracle, double spacing, const SizeField& size) const;

 private:
  enum class Kind { kField, kFormula, kFeature, kCurvature };
  Kind kind_ = Kind::kField;
  std::string text_;
  std::optional<SizeField> field_;
  std::optional<Formula> formula_;
};

}  // namespace delvox::tools
