#pragma once

#include <memory>

#include "delvox/core/mesh.h"
#include "delvox/core/samples.h"
#include "delvox/oracle/oracle.h"
#include "delvox/volume/level_set.h"
#include "delvox/volume/voxel_topology.h"

namespace delvox {

/// How a value between samples comes about (book, 14.1.3).
enum class Interpolation {
  kLinear,   ///< linear within each tet of the samples' Delaunay triangulation
  kNatural,  ///< by Sibson's natural neighbour coordinates (1981): smooth but at the samples
};

/// Scattered samples and the Delaunay triangulation of their places, which copies share. Undefined outside the convex
/// hull of the samples. May be asked by many threads at once; answers depend on nothing but the question.
class SampleField {
 public:
  /// pre: as many values as points, all finite, no two points equal. Throws InputError, without a file's name, if there
  /// are fewer than four points or all lie in one plane.
  explicit SampleField(Samples samples);

  const Samples& samples() const;
  std::size_t tet_count() const;
  /// Of the convex hull.
  double hull_mm3() const;
  /// Edge of the cube that a sample has to itself on the average, mm.
  double spacing() const;
  /// The interpolated value; NaN outside the convex hull.
  double value(const Point3& p, Interpolation interpolation = Interpolation::kLinear) const;
  /// What lies inside an isosurface of the linear interpolant.
  struct Inside {
    double mm3 = 0;
    Box3 box;
    bool on_hull = false;  ///< it reaches the convex hull
  };
  /// Throws NothingToMesh if no sample is inside.
  Inside inside(const Isosurface& surface) const;

  struct Impl;
  const std::shared_ptr<const Impl>& impl() const { return impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

/// The isosurface of interpolated samples as a domain: inside is where the value is at or above the isovalue (`below`:
/// at or below it) within the convex hull of the samples, along which the surface closes. Samples that equal the
/// isovalue count as inside: it is moved outwards by a hair, at most 1e-9 of the range of the values.
/// Linear: every crossing of a segment is found, tet by tet; topology() is that of the interpolant. Natural: crossings
/// are looked for in steps of a quarter of the way through each tet, and lie on the surface to rounding.
/// Throws NothingToMesh if no sample is inside.
std::unique_ptr<Oracle> make_samples_oracle(const SampleField& field, const Isosurface& surface,
                                            Interpolation interpolation = Interpolation::kLinear);

/// Components, cavities, Euler number and volume of the same. Throws NothingToMesh if no sample is inside.
VoxelTopology count_samples_topology(const SampleField& field, const Isosurface& surface);

/// The surface that make_samples_oracle's linear domain has, as the polygons it consists of: of each tet a triangle or
/// two, of the convex hull what is inside. Closed, oriented outward. Throws NothingToMesh if no sample is inside.
SurfaceMesh samples_isosurface(const SampleField& field, const Isosurface& surface);

}  // namespace delvox
