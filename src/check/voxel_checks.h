#pragma once

#include <span>

#include "check/report_builder.h"
#include "check/surface_topology.h"

namespace delvox::check {

/// What the comparison with the voxels needs to know of the mesh.
struct SurfaceOfMesh {
  const std::vector<Point3>& points;
  std::span<const Triangle> triangles;
  const SurfaceTopology& topology;
  double volume_mm3;
  const Promises& bounds;
  Precision precision;
  bool open_border;
  bool lies_on_isosurface;  ///< the mesh says that its nodes are on it
  std::span<const std::uint32_t> mid_nodes;  ///< mid-side nodes that are to be on it too
};

/// The checks that need the volume: nodes on the isosurface, surface balls, rim on the border, topology, distances.
/// pre: options.volume is set.
void check_against_voxels(const SurfaceOfMesh& mesh, const Isosurface& surface, const CheckOptions& options,
                          ReportBuilder& builder, CheckReport& report);

}  // namespace delvox::check
