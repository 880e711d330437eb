#pragma once

#include <limits>

#include "delvox/meshing/criteria.h"
#include "meshing/tet_geometry.h"

namespace delvox {

/// What a tet is held to, and by how much it falls short of the bound on dihedral angles.
class TetLimits {
 public:
  TetLimits(double min_dihedral_degrees, const TetCriteria& criteria);

  /// Of the smallest dihedral angle wanted.
  double goal_cosine() const { return goal_; }
  /// 0 if the dihedral angles are fine, up to 1 for a flat tet.
  double shortfall_of(double largest_cosine) const {
    return largest_cosine <= goal_ ? 0 : (largest_cosine - goal_) / (1 - goal_);
  }
  /// Of a tet that is there, whatever else may be wrong with it.
  double shortfall(const Point3& a, const Point3& b, const Point3& c, const Point3& d) const {
    const double s = shortfall_of(tet_geometry(a, b, c, d).largest_cosine());
    return s <= 1 ? s : 1;
  }
  /// Of a tet that is to be made: infinite if it is not positive or breaks a bound other than that of angles.
  double price(const Point3& a, const Point3& b, const Point3& c, const Point3& d) const {
    const TetGeometry g = tet_geometry(a, b, c, d);
    return allows(g) ? shortfall_of(g.largest_cosine()) : std::numeric_limits<double>::infinity();
  }
  bool allows(const TetGeometry& g) const {
    // A volume of this share of that of a regular tet is far beyond rounding: its sign is right.
    const double e = g.shortest_squared_edge;
    return g.six_volumes > kLeastVolume * e * std::sqrt(e) &&
           g.squared_circumradius <= squared_radius_edge_ * g.shortest_squared_edge &&
           g.squared_circumradius <= (constant_ ? squared_size_ : squared_size_at(g.circumcenter));
  }

 private:
  static constexpr double kLeastVolume = 1e-7;
  double squared_size_at(const Point3& p) const {
    const double size = cell_size_(p);
    return size * size;
  }

  double goal_, squared_radius_edge_, squared_size_;
  bool constant_;
  SizeField cell_size_;
};

}  // namespace delvox
