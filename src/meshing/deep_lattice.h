#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/ids.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// Tetrahedra of a mesh that are known without being inserted; the triangulation holds what surrounds them. A corner's
/// number is that of a shell site, which is a vertex, or, from `shell.size()` on, of a deep point, which is none.
struct DeepLattice {
  std::vector<std::array<std::uint32_t, 4>> tets;  ///< positive
  std::vector<VertexId> shell;
  std::vector<Point3> points;
  std::vector<Label> labels;                       ///< of the deep points, and of the tets that they are corners of

  /// Of a corner; kNone if it is a deep point.
  VertexId vertex(std::uint32_t corner) const { return corner < shell.size() ? shell[corner] : kNone; }

  /// Deep points no farther from a place than `reach` and the distance of the nearest of them: from now on they are the
  /// last of the shell, in the order returned, and wait for their vertices. Tets without deep corners are gone.
  std::vector<Point3> take_near(const Point3& place, double reach);
};

}  // namespace delvox
