#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "oracle/polygon_tree.h"

namespace delvox {

/// A grid of blocks over a closed surface, as bricks are for voxels: those that no triangle touches have one label; in
/// the others a point of known label is near, so that a label takes a short segment instead of a ray.
class PolygonBlocks {
 public:
  /// Keeps a reference to the tree.
  PolygonBlocks(const PolygonSurface& surface, const PolygonTree& tree);

  /// Whether p is inside or on the surface.
  bool inside(const Point3& p) const;

  /// Calls visit(center, is_inside) for each block, in one fixed order; blocks with surface go by a point in them.
  void for_each(const std::function<void(const Point3& center, bool is_inside)>& visit) const;
  double width() const { return width_; }
  /// The number of the block that holds a point of the surface's box.
  std::size_t block_at(const Point3& p) const { return index(cell_of(p)); }
  std::size_t count() const { return states_.size(); }

 private:
  using Cell = std::array<int, 3>;
  enum : std::uint8_t { kOutside, kInside, kMixed };  // kMixed + 2 * attempts + label of the reference

  Cell cell_of(const Point3& p) const;
  std::size_t index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * counts_[1] + c[1]) * counts_[0] + c[0];
  }
  Box3 box_of(const Cell& low, const Cell& high) const;
  Point3 center_of(const Cell& c) const;
  Point3 reference(const Cell& c, int attempt) const;
  void mark_mixed(const std::array<Point3, 3>& triangle, const Cell& low, const Cell& high);
  void label_row(int j, int k);

  const PolygonTree& tree_;
  Box3 box_;
  double width_ = 1;
  Cell counts_{};
  std::vector<std::uint8_t> states_;
};

}  // namespace delvox
