#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// From cell to cell along a segment. Seen along it, the segment is one point, and it leaves a cell through the facet
/// whose edges all have that point on their left: two cells agree on that to the last bit, as they see their common
/// facet alike.
class LinkWalk {
 public:
  /// From a, in `cell`, towards b. pre: a != b.
  LinkWalk(const RestrictedDelaunay& delaunay, const Point3& a, const Point3& b, CellId cell)
      : delaunay_(&delaunay), a_(a), along_(b - a), cell_(cell) {
    const Vector3 size{std::abs(along_.x), std::abs(along_.y), std::abs(along_.z)};
    const int shortest = size.x <= size.y ? (size.x <= size.z ? 0 : 2) : (size.y <= size.z ? 1 : 2);
    Vector3 unit;
    unit[shortest] = 1;
    right_ = cross(along_, unit);
    up_ = cross(along_, right_);
  }

  CellId cell() const { return cell_; }
  /// To the cell beyond the facet that the line through a and b leaves by. False if there is none, or if rounding leads
  /// astray.
  bool next() {
    const int facet = way_out();
    if (facet < 0) return false;
    entered_ = FacetId{cell_, facet};
    cell_ = delaunay_->neighbors(cell_)[facet];
    return cell_ != RestrictedDelaunay::kBeyond;
  }
  /// The middle of what the cell has of the segment; none if it has nothing of it.
  std::optional<Point3> middle() const {
    const double start = entered_.cell == kNone ? 0 : std::max(0.0, where(entered_));
    if (!(start < 1)) return std::nullopt;
    const int facet = way_out();
    const double end = facet < 0 ? 1 : std::max(start, std::min(1.0, where({cell_, facet})));
    return a_ + (0.5 * (start + end)) * along_;
  }

 private:
  int way_out() const {
    const auto& vertices = delaunay_->vertices(cell_);
    std::array<double, 4> x, y;
    for (int i = 0; i < 4; ++i) {
      const Vector3 from_a = delaunay_->point(vertices[i]) - a_;
      x[i] = dot(right_, from_a);
      y[i] = dot(up_, from_a);
    }
    // Without branches: which it is cannot be foreseen. A facet that is seen edge on has no area.
    const auto area = [&](int i, int j) { return x[i] * y[j] - y[i] * x[j]; };
    unsigned ways = 0;
    for (int i = 0; i < 4; ++i) {
      const auto& corners = kTetFaces[i];
      const double first = area(corners[0], corners[1]), second = area(corners[1], corners[2]),
                   third = area(corners[2], corners[0]);
      const bool is_way = (first >= 0) & (second >= 0) & (third >= 0) & (first + second + third > 0);
      ways |= static_cast<unsigned>(is_way & (delaunay_->neighbors(cell_)[i] != entered_.cell)) << i;
    }
    return ways == 0 ? -1 : std::countr_zero(ways);
  }
  /// Where the segment meets the facet's plane, as a part of its length. No number at all if it lies in it but for
  /// rounding: std::min and std::max above then keep their first argument.
  double where(FacetId facet) const {
    const auto v = delaunay_->vertices(facet);
    const Point3& p = delaunay_->point(v[0]);
    const Vector3 outward = cross(delaunay_->point(v[1]) - p, delaunay_->point(v[2]) - p);
    return dot(outward, p - a_) / dot(outward, along_);
  }

  const RestrictedDelaunay* delaunay_;
  Point3 a_;
  Vector3 along_, right_, up_;
  CellId cell_;
  FacetId entered_;  // seen from the cell before
};

}  // namespace delvox
