#pragma once

#include "delvox/oracle/oracle.h"
#include "oracle/surface_cover.h"

namespace delvox {

/// The domain where a smooth function is at most 0, inside the box of its cover: intersect_all and the components of
/// seeds miss nothing, whatever the size. Function and cover must outlive this and its clones. Clones may be asked
/// beside each other, but not while the cover is asked something.
class CertifiedOracle final : public SmoothOracle {
 public:
  explicit CertifiedOracle(const SurfaceCover& cover) : cover_(cover) {}

  Box3 bounds() const override { return cover_.box(); }
  Label label(const Point3& p) const override { return cover_.box().contains(p) && value(p) >= 0 ? 1 : 0; }
  double value(const Point3& p) const override;
  Vector3 gradient(const Point3& p) const override;
  Point3 intersect(const Point3& a, const Point3& b) const override;
  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override;
  /// Critical points of the surface in some direction (book, 14.2.2): two or more on every component. `size` does not
  /// matter; the number of components is not counted.
  Seeds seeds(const SizeField& size, const GoOn& go_on) const override;
  std::unique_ptr<Oracle> clone() const override { return std::make_unique<CertifiedOracle>(*this); }

  /// The point of the surface that Newton's steps along the gradient lead to from p, if they do.
  std::optional<Point3> project(const Point3& p) const;

 private:
  const SurfaceCover& cover_;
};

}  // namespace delvox
