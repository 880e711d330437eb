#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/repair_mesh.h"

namespace delvox {

/// Keeps triangles of the boundary from crossing each other when some are changed. Looks them up in a tree of boxes,
/// which is made once somebody asks.
class CrossingGuard {
 public:
  explicit CrossingGuard(const RepairMesh& mesh) : mesh_(mesh) {}

  /// Whether a triangle, with corner `moved` (if it has it) at `place`, crosses one of the boundary, by exact
  /// predicates. Those in `gone` do not count.
  bool crosses(const Triangle& triangle, std::uint32_t moved, const Point3& place, std::span<const std::uint32_t> gone);
  bool crosses(const Triangle& triangle, std::span<const std::uint32_t> gone) {
    return crosses(triangle, RepairMesh::kNone, {}, gone);
  }
  /// To be told of triangles of the boundary that have changed.
  void changed(std::span<const std::uint32_t> triangles);

 private:
  static constexpr std::size_t kLeaf = 4;  // triangles in one
  void build();
  Box3 box_of(std::uint32_t triangle) const;
  struct Placed;
  bool crosses(const Placed& triangle, const Box3& box, std::uint32_t other, std::span<const std::uint32_t> gone) const;

  const RepairMesh& mesh_;
  std::vector<std::uint32_t> order_, place_;  // of triangles along a space-filling curve, and where each is in it
  std::size_t leaves_ = 0;                    // a power of two
  std::vector<Box3> boxes_;                   // node i has children 2 i and 2 i + 1; the leaves come last
  std::vector<std::uint32_t> late_;           // triangles with numbers that there were none of when the tree was made
};

}  // namespace delvox
