#pragma once

#include <cstddef>

#include "bench_image.h"
#include "delvox/core/mesh.h"

namespace delvox::bench {

/// Tets with a smaller dihedral angle count as slivers.
inline constexpr double kMinDihedralDegrees = 15;

/// What is said of every contender's mesh, computed by one piece of code from points and tets alone.
struct MeshMeasures {
  std::size_t tets = 0;
  std::size_t vertices = 0;            ///< used by tets
  std::size_t parts = 0;               ///< sets of tets joined by shared vertices
  std::size_t boundary_triangles = 0;  ///< faces in one tet
  std::size_t bad_edges = 0;           ///< boundary edges that are not in exactly two boundary triangles
  std::size_t bad_vertices = 0;        ///< boundary vertices whose triangles form more than one fan
  std::size_t flat_tets = 0;           ///< volume 0 or less: orientation not as delvox/core/mesh.h has it
  double volume_mm3 = 0;
  double min_dihedral_degrees = 180;
  std::size_t slivers = 0;
  double min_angle_degrees = 180;  ///< of boundary triangles
  double max_radius_edge = 0;
  double max_circumradius = 0;  ///< mm
  double max_off_voxels = 0;    ///< |h - V| / |grad h| over boundary vertices, in voxel units
  double mean_off_voxels = 0;
};

MeshMeasures measure(const TetMesh& mesh, const BenchImage& image);

}  // namespace delvox::bench
