#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
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

/// Edges of a tet in the order of its mid-side nodes (that of VTK, Abaqus, Nastran and FEBio; other formats' orders:
/// src/mesh_io/node_order.h).
inline constexpr int kTetEdges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
/// Indices of the mid-side nodes of a quadratic tet, on its edges in the order of kTetEdges.
using MidNodes = std::array<std::uint32_t, 6>;

/// Indices of the two ends of an edge.
using Edge = std::array<std::uint32_t, 2>;

/// One face of a tet of a mesh.
struct TetFace {
  std::uint32_t tet = 0;  ///< index
  std::uint8_t face = 0;  ///< of kTetFaces: it lies opposite that corner
  friend auto operator<=>(const TetFace&, const TetFace&) = default;
};

/// The same place as nodes, as tets and as boundary faces, under one name: for supports, loads and materials.
/// Each list rises and may be empty. Mid-side nodes belong to `nodes` too.
struct MeshSet {
  std::string name;
  std::vector<std::uint32_t> nodes;
  std::vector<std::uint32_t> tets;
  std::vector<TetFace> faces;
  friend bool operator==(const MeshSet&, const MeshSet&) = default;
};

/// What the tets of one region are made of: isotropic, linearly elastic.
struct Material {
  std::string name;
  Label region = 1;
  double youngs_modulus_mpa = 0;
  double poisson_ratio = 0;
  double density_kg_m3 = 0;  ///< 0: not known
  friend bool operator==(const Material&, const Material&) = default;
};

/// What files state coordinates in. In memory they are always millimetres.
enum class LengthUnit { kMillimetre, kMetre };

/// Numeric bounds that a mesh claims to meet; unset means no claim. Written to formats that can
/// carry them (VTU field data), so that `delvox check` can hold a mesh to its word.
struct Promises {
  std::optional<double> min_angle_degrees;     ///< smallest angle of a boundary triangle
  std::optional<double> radius_edge;           ///< largest circumradius / shortest edge of a tet
  std::optional<double> size;                  ///< largest surface Delaunay ball radius, mm
  std::optional<double> cell_size;             ///< largest circumradius of a tet, mm
  std::optional<double> grade;                 ///< circumradius of a tet beyond `size`, per mm of depth
  std::optional<double> max_deviation;         ///< circumcentre of triangle to surface ball centre, mm
  std::optional<double> max_roughness_degrees;  ///< largest angle between the normals of neighbouring triangles
  std::optional<double> min_dihedral_degrees;  ///< smallest dihedral angle of a tet
  /// Edges of the input sharper than this are kept; cells that touch them are not held to bounds on their shapes.
  std::optional<double> feature_angle_degrees;
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
  LengthUnit unit = LengthUnit::kMillimetre;  ///< of the file that it is read from or written to
  friend bool operator==(const MeshInfo&, const MeshInfo&) = default;
};

/// A triangulated surface.
struct SurfaceMesh {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  MeshInfo info;
  std::vector<Edge> features;  ///< edges that follow sharp edges of the input; empty if not known
};

/// A tetrahedral mesh with its boundary.
struct TetMesh {
  std::vector<Point3> points;
  std::vector<Tet> tets;
  std::vector<Label> regions;             ///< one per tet; empty means all 1
  std::vector<Triangle> boundary;         ///< faces between a region and the outside, oriented outward
  std::vector<std::uint8_t> on_surface;   ///< one per point, 1: lies on the isosurface; empty if not known
  MeshInfo info;
  std::vector<MidNodes> mid_nodes;  ///< one per tet of second order; empty: first order
  std::vector<MeshSet> sets;
  std::vector<Material> materials;  ///< of regions, at most one each
  std::vector<Edge> features;       ///< edges that follow sharp edges of the input; empty if not known
};

/// What readers return, and writers and the checker take.
using Mesh = std::variant<SurfaceMesh, TetMesh>;

/// The corners of a face, counter-clockwise seen from outside its tet.
Triangle face_corners(const std::vector<Tet>& tets, TetFace face);

/// Those of a tet's mid-side nodes that lie on a face of kTetFaces, on its edges 01, 12, 20.
std::array<std::uint32_t, 3> face_mid_nodes(const MidNodes& of_tet, int face);

/// Faces that occur in exactly one tet, in the order of their tets.
std::vector<TetFace> boundary_faces(const std::vector<Tet>& tets);

/// The same as triangles, oriented outward.
std::vector<Triangle> boundary_of(const std::vector<Tet>& tets);

/// The boundary of a tet mesh as a surface of its own, points renumbered in the order of first use.
SurfaceMesh boundary_surface(const TetMesh& mesh);

}  // namespace delvox
