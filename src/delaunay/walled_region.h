#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/delaunay3.h"

namespace delvox {

/// The cells inside a closed surface of facets, and the guards: cells that share a wall with them from outside.
class WalledRegion {
 public:
  using Wall = std::array<VertexId, 3>;

  /// `walls`: each counter-clockwise seen from outside the region. False, and the region is empty, unless every wall is
  /// a facet of the triangulation.
  bool enclose(const Delaunay3& delaunay, const std::vector<Wall>& walls);
  void clear() { places_.clear(); }

  bool empty() const { return places_.empty(); }
  bool inside(CellId cell) const { return cell < places_.size() && places_[cell] == kInside; }
  /// Inside or a guard. An insertion whose zone holds no such cell changes nothing inside.
  bool guarded(CellId cell) const { return cell < places_.size() && places_[cell] != kElsewhere; }

 private:
  enum Place : std::uint8_t { kElsewhere, kInside, kGuard };
  std::vector<Place> places_;  // cells made later are elsewhere: no insertion may touch these
};

}  // namespace delvox
