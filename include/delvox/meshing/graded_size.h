#pragma once

#include <memory>

#include "delvox/core/size_field.h"
#include "delvox/meshing/criteria.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

class DepthTree;

/// How far inside a domain a place lies: its distance from the surface, mm, as known from points on the surface about
/// 0.7 sizes apart: too small by up to a size and a third of the depth; too large by less than a size, and by that at
/// the surface only. Copies share what was computed.
class DepthField {
 public:
  /// `size`: of the surface to be meshed. Takes about as long as the seeds of a surface of that size do. Throws what
  /// go_on throws.
  DepthField(const Oracle& oracle, const SizeField& size, const GoOn& go_on = always_go_on);

  /// 0 outside; undefined outside within a few sizes of the surface. Thread-safe.
  double operator()(const Point3& p) const;
  /// Of the deepest place.
  double maximum() const;

 private:
  std::shared_ptr<const DepthTree> tree_;
};

/// Tets that grow with depth: the bound on circumradii becomes size + grade * depth, both at the circumcentre, but
/// nowhere more than `tets.cell_size`, which may be infinite. grade: 0 to 1; from about 1 on the radius-edge bound
/// alone makes tets grow. `size`: of the surface.
TetCriteria graded(TetCriteria tets, const SizeField& size, const DepthField& depth, double grade);

}  // namespace delvox
