#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Indices of three points, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;
/// Indices of four points; positive: (p1-p0) x (p2-p0) . (p3-p0) > 0 (the order of VTK and Abaqus).
using Tet = std::array<std::uint32_t, 4>;

/// Faces of a positive tet, each counter-clockwise seen from outside; face i lies opposite vertex i.
inline constexpr int kTetFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Numeric bounds that a mesh claims to meet; unset means no claim. Written to formats that can
/// carry them (VTU field data), so that `delvox check` can hold a mesh to its word.
struct Promises {
  std::optional<double> min_angle_degrees;     ///< smallest angle of a boundary triangle
  std::optional<double> radius_edge;           ///< largest circumradius / shortest edge of a tet
  std::optional<double> size;                  ///< largest surface Delaunay ball radius, mm
  std::optional<double> cell_size;             ///< largest circumradius of a tet, mm
  std::optional<double> max_deviation;         ///< circumcentre of triangle to surface ball centre, mm
  std::optional<double> min_dihedral_degrees;  ///< smallest dihedral angle of a tet
  friend bool operator==(const Promises&, const Promises&) = default;
};

/// What a mesh says of itself beside its points and cells.
struct MeshInfo {
  Frame frame = Frame::kUnknown;
  Promises promises;
  std::optional<double> isovalue;  ///< of the surface that the boundary nodes lie on
  bool below = false;              ///< inside is where the volume is <= isovalue
  bool open_border = false;        ///< the surface ends at the image border (a rim is expected)
  bool complete = true;            ///< false: a limit stopped the run and promises may not hold
  friend bool operator==(const MeshInfo&, const MeshInfo&) = default;
};

/// A triangulated surface.
struct SurfaceMesh {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  MeshInfo info;
};

/// A tetrahedral mesh with its boundary.
struct TetMesh {
  std::vector<Point3> points;
  std::vector<Tet> tets;
  std::vector<Label> regions;             ///< one per tet; empty means all 1
  std::vector<Triangle> boundary;         ///< faces between a region and the outside, oriented outward
  std::vector<std::uint8_t> on_surface;   ///< one per point, 1: lies on the isosurface; empty if not known
  MeshInfo info;
};

/// What readers return, and writers and the checker take.
using Mesh = std::variant<SurfaceMesh, TetMesh>;

/// Faces that occur in exactly one tet, oriented outward, in the order of their tets.
std::vector<Triangle> boundary_of(const std::vector<Tet>& tets);

/// The boundary of a tet mesh as a surface of its own, points renumbered in the order of first use.
SurfaceMesh boundary_surface(const TetMesh& mesh);

}  // namespace delvox
