#pragma once

#include <vector>

#include "meshing/crossing_guard.h"
#include "meshing/repair_mesh.h"
#include "meshing/surface_limits.h"
#include "meshing/tet_limits.h"

namespace delvox {

/// Moves single vertices to where the smallest dihedral angle of the tets around them is larger: non-smooth
/// optimisation (Freitag and Ollivier-Gooch, "Tetrahedral Mesh Improvement Using Swapping and Smoothing", 1997;
/// Klingner and Shewchuk, "Aggressive Tetrahedral Mesh Improvement", 2007). Vertices of the boundary slide on the
/// surface.
class StarSmoothing {
 public:
  StarSmoothing(const RepairMesh& mesh, const TetLimits& tets, const SurfaceLimits& surface, CrossingGuard& guard)
      : mesh_(mesh), tets_(tets), surface_(surface), guard_(guard) {}

  /// A better place for a vertex: by how much shortfalls become less there, and the place; 0 if none is found.
  double improve(std::uint32_t vertex, Point3& place);
  /// A place one step away, for vertices of the boundary on the surface beside it, better or worse: by how much
  /// shortfalls become less there, and the place; less infinity if another bound would break, or if the vertex is fixed.
  double displace(std::uint32_t vertex, const Vector3& step, Point3& place);

 private:
  struct Corner {
    Point3 a, b, c;  // the tet is positive in the order vertex, a, b, c
  };
  struct Slope {
    double value;
    Vector3 gradient;
  };
  struct State {
    Point3 place;
    double worst = 0;      // largest cosine
    double shortfall = 0;  // sum
  };

  bool gather(std::uint32_t vertex);
  bool measure(const Point3& place, State& state, double limit);
  void find_slopes(const State& state);
  void add_surface_slopes(const State& state);
  Vector3 descent() const;
  std::optional<Point3> reach(const Point3& from, const Vector3& step) const;
  bool triangles_allow(const Point3& place);
  bool step_down(State& state, const Vector3& direction, double length);

  const RepairMesh& mesh_;
  const TetLimits& tets_;
  const SurfaceLimits& surface_;
  CrossingGuard& guard_;
  std::vector<Corner> star_;
  struct Side {
    Point3 a, b;  // the triangle is vertex, a, b
  };
  std::vector<Side> fan_;
  std::uint32_t vertex_ = 0;
  std::vector<Slope> slopes_;
  Vector3 outward_;
  double shortest_ = 0;
  Label region_ = 1;
  bool near_boundary_ = false;
};

}  // namespace delvox
