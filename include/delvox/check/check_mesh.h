#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "delvox/core/mesh.h"
#include "delvox/oracle/implicit_oracle.h"
#include "delvox/volume/level_set.h"
#include "delvox/volume/voxel_topology.h"

namespace delvox {

/// Cheap: everything that needs the mesh alone; a fraction of a second for a million tets, run after every mesher.
/// Full: adds crossing triangles, and everything that compares the mesh with a volume, a polygon surface or a function.
enum class CheckLevel { kCheap, kFull };

/// What check_mesh holds a mesh to.
struct CheckOptions {
  CheckLevel level = CheckLevel::kFull;
  std::optional<Promises> bounds;      ///< numeric bounds to test; default: those that the mesh carries
  std::optional<bool> open_border;     ///< a rim on the image border is expected; default: what the mesh says
  double coordinate_error = 0;         ///< relative rounding of a coordinate in the file it came from (0: exact double)
  const Volume* volume = nullptr;      ///< compare with this image, in the same frame as the mesh
  std::optional<Isosurface> isosurface;  ///< of the volume; default: the isovalue that the mesh carries
  std::optional<double> node_tolerance_voxels;  ///< how far a surface node may lie from the isosurface;
                                                ///< default: 1e-4 if the mesh carries an isovalue, else no bound
  const SurfaceMesh* surface = nullptr;  ///< compare with this polygon surface, in the same frame as the mesh
  /// Edges of `surface` between facets whose normals are further apart must be kept; default: what the mesh carries.
  std::optional<double> feature_angle_degrees;
  const ImplicitFunction* function = nullptr;  ///< compare with its zero set: a formula, the spline of a volume
  Affine3 function_to_world;                   ///< an isometry from its coordinates to those of the mesh
  bool require_same_topology = false;  ///< fail unless components and Euler number equal those of what it is compared with
};

/// How a check ended; kNotApplicable: there was nothing to hold the mesh to.
enum class CheckStatus { kPassed, kFailed, kNotApplicable };
/// "passed", "failed" or "not applicable".
const char* to_string(CheckStatus status);

/// One promise, put to the test.
struct Check {
  std::string name;  ///< "positive tets", "angle", "radius-edge", ...
  CheckStatus status = CheckStatus::kNotApplicable;
  double measured = 0;          ///< the worst value found, or the number of violations where there is no value
  std::optional<double> bound;  ///< what it is held to (for counts: 0)
  std::string unit;             ///< "deg", "mm", "voxel", "" for ratios and counts
  std::size_t violations = 0;
  std::optional<Point3> where;  ///< world position of one violation, the worst where there is a worst
  std::string note;             ///< why it does not apply, or what to know of the figure
};

/// How a quantity is spread: counts over equal bins of [low, high]; what lies beyond falls in the outermost bins.
struct Distribution {
  std::size_t count = 0;
  double min = 0, max = 0, mean = 0;
  double low = 0, high = 0;
  std::vector<std::size_t> bins;
};

/// One component of the boundary surface (triangles joined by shared edges).
struct ComponentStatistics {
  std::size_t triangles = 0;
  long euler = 0;
  long genus = 0;          ///< (2 - euler) / 2; meaningful for closed orientable components
  double volume_mm3 = 0;   ///< signed: negative for a cavity
  double area_mm2 = 0;
};

/// What a mesh is made of, and how good it is.
struct MeshStatistics {
  std::size_t points = 0, tets = 0;
  std::size_t triangles = 0;          ///< of the surface, or of the boundary of the tets
  std::size_t surface_components = 0;
  std::size_t tet_components = 0;     ///< joined by shared faces
  std::size_t cavities = 0;           ///< surface components with negative volume
  long euler = 0;                     ///< vertices - edges + triangles of the surface
  double volume_mm3 = 0, area_mm2 = 0;
  std::vector<ComponentStatistics> components;  ///< largest area first
  Distribution angle_degrees;     ///< of surface triangles
  Distribution dihedral_degrees;  ///< of tets
  Distribution radius_edge;       ///< of tets
  Distribution face_angle_degrees, aspect_ratio, shape_factor, jacobian_ratio;  ///< as solvers measure tets, full level
  Distribution edge_mm;           ///< shortest and longest edge of each tet, else the edges of the triangles
};

/// From samples of one surface to the other, mm; means are by area.
struct SurfaceDistances {
  double mesh_to_surface_max_mm = 0, mesh_to_surface_mean_mm = 0;
  double surface_to_mesh_max_mm = 0, surface_to_mesh_mean_mm = 0;
};

/// How mesh and voxels compare; filled when a volume was given and the level is full.
struct VoxelComparison {
  VoxelTopology voxels;            ///< counted on the trilinear isosurface
  double voxel_volume_mm3 = 0;     ///< enclosed by the trilinear isosurface
  double volume_ratio = 0;         ///< mesh / voxels
  SurfaceDistances distances;
};

/// How a mesh compares with a polygon surface or the zero set of a function; filled when one was given and the level is
/// full.
struct SurfaceComparison {
  std::size_t components = 0;  ///< of the polygon surface, equal points being one; of a function, as samples show them
  long euler = 0;
  SurfaceDistances distances;
};

/// How a mesh keeps the sharp edges of the polygon surface, and the triangles and tets with a corner on these, which are
/// held to no bound on their shapes.
struct FeatureComparison {
  double angle_degrees = 0;     ///< between facets' normals, above which an edge is sharp
  std::size_t sharp_edges = 0;  ///< of the surface
  double length_mm = 0;         ///< of these
  double missing_mm = 0;        ///< of these, what no edge of the mesh follows
  double distance_mm = 0;       ///< the largest from the rest to the mesh's edges
  std::size_t kept_edges = 0;   ///< of the mesh
  std::size_t triangles = 0, tets = 0;  ///< with a corner on them
  /// Of these, those beyond the bounds.
  std::size_t below_min_angle = 0, above_radius_edge = 0, below_min_dihedral = 0;
};

/// What a solver objects to by its own measure: reported, no promise of ours.
struct SolverLimit {
  std::string solver, measure;
  std::string severity;   ///< "warning" or "error"
  bool at_least = false;  ///< whether the limit is a least value
  double limit = 0;
  std::size_t count = 0;  ///< tets that it objects to
  double worst = 0;       ///< whether it does or not
  Point3 where;           ///< centroid of the worst tet
};

/// Everything that check_mesh found.
struct CheckReport {
  std::vector<Check> checks;
  MeshStatistics statistics;
  std::optional<VoxelComparison> comparison;
  std::vector<SolverLimit> solver_limits;  ///< of tets, at the full level
  std::optional<SurfaceComparison> surface_comparison;
  std::optional<FeatureComparison> feature_comparison;

  bool all_hold() const;
  /// The check of that name, or null.
  const Check* find(const std::string& name) const;
};

/// Puts every promise of a mesh to the test. Shares nothing with the mesher but the mesh types. Orientation is
/// decided by exact predicates on the coordinates as they are; numeric bounds have a relative tolerance of 1e-9 plus
/// what `coordinate_error` can move the figure to first order. Does not throw on bad meshes: it reports.
CheckReport check_mesh(const Mesh& mesh, const CheckOptions& options = {});

/// A table for people: one line per check, then the statistics.
std::string to_text(const CheckReport& report);

}  // namespace delvox
