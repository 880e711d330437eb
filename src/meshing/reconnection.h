#pragma once

#include <vector>

#include "meshing/crossing_guard.h"
#include "meshing/repair_mesh.h"
#include "meshing/surface_limits.h"
#include "meshing/tet_limits.h"

namespace delvox {

/// Finds changes of the connections between vertices that repair slivers (Shewchuk, "Two Discrete Optimization
/// Algorithms for the Topological Improvement of Tetrahedral Meshes", 2002).
class Reconnection {
 public:
  Reconnection(const RepairMesh& mesh, const TetLimits& tets, const SurfaceLimits& surface, CrossingGuard& guard)
      : mesh_(mesh), tets_(tets), surface_(surface), guard_(guard) {}

  /// The best way to fill the tets around edge ab without it: by how much shortfalls become less, and the change; less
  /// infinity if there is none that makes them more by less than `allowance`. Around an edge of the boundary, the
  /// boundary's edge is flipped with it, if its bounds allow.
  double remove_edge(std::uint32_t a, std::uint32_t b, double allowance, Change& change);

  /// The same for an edge through a face of a tet, and through more faces beside it, in place of these faces.
  double remove_faces(std::uint32_t tet, int face, double allowance, Change& change);

 private:
  struct Side {
    std::uint32_t tet, from, to;
  };
  static constexpr int kLargestRing = 9;

  bool find_ring(std::uint32_t a, std::uint32_t b);
  bool flip_boundary(std::uint32_t a, std::uint32_t b, Change& change);
  double triangulate(std::uint32_t a, std::uint32_t b, double worth);
  void collect(std::uint32_t a, std::uint32_t b, int from, int to, Change& change) const;
  double price(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) const {
    return tets_.price(mesh_.point(a), mesh_.point(b), mesh_.point(c), mesh_.point(d));
  }
  double shortfall(std::uint32_t tet) const {
    const Tet& t = mesh_.tet(tet);
    return tets_.shortfall(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
  }
  std::uint32_t beyond(std::uint32_t tet, std::uint32_t u, std::uint32_t v, std::uint32_t apex) const;
  int corner_beside(std::uint32_t tet, std::uint32_t u, std::uint32_t v, std::uint32_t w) const;
  double beyond_edge(std::uint32_t u, std::uint32_t v, std::uint32_t tet_below, std::uint32_t tet_above, int depth,
                     Change& change);

  const RepairMesh& mesh_;
  const TetLimits& tets_;
  const SurfaceLimits& surface_;
  CrossingGuard& guard_;
  std::vector<Side> sides_;  // of the tets around the edge
  std::vector<std::uint32_t> ring_, ring_tets_;
  bool open_ = false;  // the edge is on the boundary
  double cost_[kLargestRing][kLargestRing];
  int apex_[kLargestRing][kLargestRing];
  std::uint32_t below_ = 0, above_ = 0;  // ends of the edge that replaces faces
};

}  // namespace delvox
