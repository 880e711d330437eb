#pragma once

#include <optional>

#include "delvox/meshing/criteria.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What a triangle of the boundary is held to, and where its corners may go.
class SurfaceLimits {
 public:
  /// The oracle and the criteria must outlive this.
  SurfaceLimits(const Oracle& oracle, const SurfaceCriteria& criteria);

  /// Angles and size; of the surface balls around the triangle the nearest is looked at.
  bool allows(const Point3& a, const Point3& b, const Point3& c) const;
  /// The angles only.
  bool allows_angles(const Point3& a, const Point3& b, const Point3& c) const;
  double largest_cosine() const { return largest_cosine_; }
  /// The point of the surface on the line through p along the unit vector `outward`, at most `reach` away, where
  /// `label` is left; none if the line does not leave it there.
  std::optional<Point3> project(const Point3& p, const Vector3& outward, double reach, Label label) const;
  /// The point of the surface that is nearest to p on the line through it along the unit vector `outward`, on that side
  /// of p where `label` is left outward or entered inward; at most `reach` away.
  std::optional<Point3> nearest(const Point3& p, const Vector3& outward, double reach, Label label) const;
  bool inside(const Point3& p, Label label) const { return oracle_.label(p) == label; }
  double max_roughness_degrees() const { return criteria_.max_roughness_degrees; }
  double largest_size() const { return criteria_.size.maximum(); }

 private:
  const Oracle& oracle_;
  const SurfaceCriteria& criteria_;
  double largest_cosine_;
};

}  // namespace delvox
