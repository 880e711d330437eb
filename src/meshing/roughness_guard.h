#pragma once

#include <cstdint>
#include <span>

#include "meshing/repair_mesh.h"

namespace delvox {

/// Keeps edges of the boundary from becoming rougher than a bound when some of its triangles are changed.
class RoughnessGuard {
 public:
  /// `max_degrees` from 180: never forbids anything.
  RoughnessGuard(const RepairMesh& mesh, double max_degrees) : mesh_(mesh), max_degrees_(max_degrees * (1 - 1e-9)) {}

  /// Whether triangles in place of those in `gone`, with corner `moved` (if they have it) at `place`, make an edge too
  /// rough, among themselves or with the rest of the boundary.
  bool too_rough(std::span<const Triangle> triangles, std::uint32_t moved, const Point3& place,
                 std::span<const std::uint32_t> gone) const;
  bool too_rough(std::span<const Triangle> triangles, std::span<const std::uint32_t> gone) const {
    return too_rough(triangles, RepairMesh::kNone, {}, gone);
  }

 private:
  const RepairMesh& mesh_;
  double max_degrees_;
};

}  // namespace delvox
