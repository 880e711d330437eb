#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "check/element_quality.h"

namespace delvox::check {

/// Where a mesh follows sharp edges of the surface that it was made from.
struct KeptFeatures {
  std::vector<std::uint8_t> touched;  ///< per point of the mesh: it lies on a sharp edge
  std::vector<Edge> edges;            ///< of the mesh, on sharp edges, the lower number first, in order
  std::size_t sharp_edges = 0;        ///< of the surface
  double length_mm = 0;               ///< of these
  double distance_mm = 0;             ///< the largest from what is followed to the mesh's edges
  double missing_mm = 0;              ///< length that no edge of the mesh follows
  Tally missing;                      ///< pieces of that
};

/// Looks for the edges of `surface` between triangles whose normals are more than `degrees` apart among the edges of a
/// mesh's triangles. What is within 2e-6 of the surface's diagonal, beside what `precision` says, counts as followed.
KeptFeatures find_features(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                           const SurfaceMesh& surface, double degrees, Precision precision);

/// The same from edges that the mesh names itself; nothing is known of what it lacks.
KeptFeatures named_features(std::size_t point_count, const std::vector<Edge>& edges);

/// Whether an edge is one of them.
bool is_kept(const std::vector<Edge>& kept, std::uint32_t a, std::uint32_t b);

}  // namespace delvox::check
