#pragma once

#include <algorithm>
#include <vector>

#include "meshing/crossing_guard.h"
#include "meshing/reconnection.h"
#include "meshing/repair_mesh.h"
#include "meshing/star_smoothing.h"

namespace delvox {

/// Repairs single tets where one change is enough, and keeps account of what it leaves behind. Gains are by how much
/// shortfalls become less in all.
class LocalRepair {
 public:
  LocalRepair(RepairMesh& mesh, const TetLimits& tets, const SurfaceLimits& surface)
      : mesh_(mesh),
        tets_(tets),
        guard_(mesh),
        reconnection_(mesh, tets, surface, guard_),
        smoothing_(mesh, tets, surface, guard_) {}

  double shortfall(std::uint32_t tet) const {
    const Tet& t = mesh_.tet(tet);
    return tets_.shortfall(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
  }
  bool is_sliver(std::uint32_t tet) const { return mesh_.alive(tet) && shortfall(tet) > 0; }
  /// Less is not worth a change for the sake of a sliver: what goes on must come to an end.
  double least_gain(std::uint32_t tet) const { return std::min(1e-4, 0.5 * shortfall(tet)); }
  CrossingGuard& guard() { return guard_; }

  /// Reconnects vertices around a sliver, or moves them. Returns the gain, 0 if there was nothing to do.
  double repair(std::uint32_t tet);
  /// Makes a change; slivers among what is new come to wait.
  void apply(const Change& change);
  /// Moves a vertex by one step if that breaks no other bound; slivers around it come to wait. Returns the gain, which
  /// may be a loss, 0 if it stays.
  double displace(std::uint32_t vertex, const Vector3& step);
  /// Ways to reconnect vertices.
  Reconnection& reconnection() { return reconnection_; }
  /// Slivers that came of changes, perhaps repeated, perhaps repaired since.
  std::vector<std::uint32_t>& waiting() { return waiting_; }
  std::size_t reconnections() const { return reconnections_; }
  std::size_t moves() const { return moves_; }

 private:
  double reconnect(std::uint32_t tet);
  double move_corners(std::uint32_t tet);
  void move(std::uint32_t vertex, const Point3& place);
  void await(std::span<const std::uint32_t> tets);

  RepairMesh& mesh_;
  const TetLimits& tets_;
  CrossingGuard guard_;
  Reconnection reconnection_;
  StarSmoothing smoothing_;
  std::vector<std::uint32_t> waiting_;
  std::size_t reconnections_ = 0, moves_ = 0;
  Change change_, best_change_;
};

}  // namespace delvox
