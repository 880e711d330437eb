#pragma once

#include <string>
#include <vector>

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// The fold that leaves room for three tets of such angles side by side: DelTetSurfOptions::min_fold_degrees for a mesh
/// that slivers are to be removed from.
constexpr double min_fold_for(double min_dihedral_degrees) { return 3 * min_dihedral_degrees; }

/// What remove_slivers is asked for, and what the mesh was made with.
struct RemoveSliversOptions {
  double min_dihedral_degrees = 15;  ///< the smallest dihedral angle wanted, above 0 and up to 30
  SurfaceCriteria surface;           ///< as the mesh was made with; a deviation that it does not promise is not kept
  TetCriteria tets;                  ///< likewise
  RunControl control;                ///< of its limits, max_seconds is heeded
};

/// A tet that has a smaller dihedral angle still.
struct UnmetTet {
  Point3 where;  ///< its centroid, world
  double dihedral_degrees = 0;
  std::string reason;
  bool surface_forbids = false;  ///< no tets that keep the nodes and triangles there could do better
};

/// What remove_slivers did.
struct SliverReport {
  std::size_t slivers = 0;                   ///< tets with a smaller dihedral angle, at first
  std::size_t reconnections = 0, moves = 0;  ///< also such as were tried and taken back
  std::size_t insertions = 0, removals = 0;  ///< of nodes
  std::vector<UnmetTet> unmet;
};

/// Repairs the tets of a mesh of deltetsurf() that have a dihedral angle below the wanted one: edges and faces are
/// taken out or flipped, nodes moved, those of the boundary on the surface, and nodes put in and taken out (Klingner and
/// Shewchuk, "Aggressive Tetrahedral Mesh Improvement", 2007). All else that the mesh promises stays true after each
/// step: positive tets, a boundary of the same topology on the surface, which does not cross itself, its angles and
/// sizes, radius-edge ratios, cell sizes. If nothing is left, the mesh promises the angle; what is left is told in both
/// reports and breaks no promise. Tets and points are renumbered. `report` is that of deltetsurf(). pre: first order, no
/// sets. Throws OptionError, Cancelled.
SliverReport remove_slivers(TetMesh& mesh, const Oracle& oracle, const RemoveSliversOptions& options,
                            RunReport& report);

}  // namespace delvox
