#pragma once

#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "delvox/core/mesh.h"

namespace delvox {

/// All that lies beyond a plane, on the side its normal points to; with a thickness only what is that near to it.
struct PlaneRule {
  Point3 point;
  Vector3 normal;                                              ///< of any length but 0
  double thickness = std::numeric_limits<double>::infinity();  ///< mm, to both sides
};
/// All that lies in a box.
struct BoxRule {
  Box3 box;
};
/// All that lies in a ball.
struct SphereRule {
  Point3 center;
  double radius = 0;  ///< mm
};
/// The boundary that faces a direction.
struct NormalRule {
  Vector3 direction;   ///< of any length but 0
  double degrees = 0;  ///< largest angle between it and the outward normal of a face
};
/// The boundary that lies beyond a plane and faces away from it: where an organ is cut by the image edge.
struct BorderRule {
  Point3 point;
  Vector3 outward;
};
/// The patch of boundary around the place nearest to a point.
struct NearRule {
  Point3 point;
  double radius = 0;  ///< mm: how far from that place its faces may reach, along connected faces
};
/// The whole mesh.
struct AllRule {};

/// A place in words, to be found in a mesh. Lengths in mm, in the frame of the mesh.
using SetRule = std::variant<PlaneRule, BoxRule, SphereRule, NormalRule, BorderRule, NearRule, AllRule>;

/// A rule and the name of what it finds.
struct NamedRule {
  std::string name;
  SetRule rule;
};

/// What the rules find, in their order; parts may be empty. Rules on space (plane, box, sphere, all) take the nodes
/// that lie there, the tets whose centroids do, and the boundary faces whose corners all do. Rules on the boundary
/// (normal, border, near) take its faces, their nodes, and the tets they belong to.
std::vector<MeshSet> select_sets(const TetMesh& mesh, const std::vector<NamedRule>& rules);

}  // namespace delvox
