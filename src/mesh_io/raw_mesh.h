#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "delvox/mesh_io/read_mesh.h"
#include "mesh_io/source.h"

namespace delvox::mesh_io {

/// Relative rounding of a coordinate kept as float32.
inline constexpr double kFloat32Error = 1.0 / (1 << 24);

/// What to do with a cell of a file, whatever its format calls it.
enum class CellKind {
  kIgnored,   ///< points and curves: no part of the mesh
  kTriangle,  ///< also of higher order: corners first, then mid nodes
  kPolygon,
  kStrip,     ///< triangle strip
  kTet,       ///< also of higher order: corners first, then mid nodes
  kUnsupported,
};

/// Millimetres in a metre: files in metres are brought to millimetres as they are read.
inline constexpr double kMmPerMetre = 1000;

/// A set as a file states it: indices of what has been read so far.
struct RawSet {
  std::vector<std::uint32_t> nodes;
  std::vector<TetFace> faces;
  std::vector<std::uint32_t> tets;
  std::vector<Triangle> triangles;  ///< by their corners, whichever tet they belong to; in any orientation
};

/// What a reader has found so far, unchecked.
struct RawMesh {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  std::vector<Tet> tets;
  std::vector<Label> regions;             ///< one per tet, or empty
  std::vector<std::uint8_t> on_surface;   ///< one per point, or empty
  MeshInfo info;
  double coordinate_error = 0;
  std::vector<std::pair<std::string, RawSet>> sets;
  std::vector<MidNodes> mid_nodes;  ///< of tets of second order; whole if as many as tets

  /// The set of that name, made if there is none.
  RawSet& set(const std::string& name);

  /// Adds one cell; nodes are indices into points, which may still be missing, in
  /// our order. `name` is what the format calls it.
  void add_cell(const Source& source, CellKind kind, std::span<const std::int64_t> nodes, const std::string& name);
  /// Adds a cell to tets or triangles as its kind says and, if it is a tet, its region.
  void add_cell(const Source& source, CellKind kind, std::span<const std::int64_t> nodes, const std::string& name,
                std::int64_t region);

  /// Checks everything and makes the mesh: of tets if there are any, else of triangles and triangulated polygons.
  Mesh finish(const Source& source) &&;

 private:
  std::vector<std::uint32_t> drop_mid_nodes();
  std::vector<MeshSet> finished_sets(const Source& source, const std::vector<std::uint32_t>& renumbered) const;
  void triangulate_polygons(const Source& source);

  std::map<std::string, std::size_t> set_index_;  ///< into sets
  std::vector<std::vector<std::uint32_t>> polygons_;
  std::vector<std::uint32_t> mid_nodes_;
};

}  // namespace delvox::mesh_io
