#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "delvox/core/geometry.h"

namespace delvox {

/// Indices of points, round after round.
struct SpatialOrder {
  std::vector<std::uint32_t> indices;
  std::vector<std::size_t> round_ends;  ///< where in `indices` each round ends

  auto begin() const { return indices.begin(); }
  auto end() const { return indices.end(); }
};

/// Indices of the points in biased randomised insertion order: rounds that grow fourfold, drawn by a hash of the
/// coordinates, each sorted along a Hilbert-like curve (Amenta, Choi, Rote, "Incremental constructions con BRIO",
/// 2003). Depends on the points alone.
SpatialOrder spatial_order(const std::vector<Point3>& points);

/// Where a point of the box comes along a Hilbert curve through it.
std::uint64_t place_along_curve(const Point3& p, const Box3& box);

/// A 64-bit hash of a point's coordinates.
std::uint64_t hash_point(const Point3& p);

}  // namespace delvox
