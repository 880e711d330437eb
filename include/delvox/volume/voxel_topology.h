#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "delvox/core/geometry.h"
#include "delvox/volume/level_set.h"
#include "delvox/volume/volume_source.h"

namespace delvox {

/// Topology of the trilinear isosurface of a padded volume: exact for the trilinear function g with the samples and
/// the level as LevelSet gives them (where a face saddle lies exactly on the level the surface is no manifold; its
/// two inside corners then count as separate, and so do the outside ones).
///
/// Euler number. Cut the inside U = {g > level} along the grid into open strata (vertices, edges, faces, cells); the
/// compactly supported Euler characteristic adds up over them. A vertex counts 1, an edge with an inside end -1 (an
/// open interval), a face its number of inside components (open discs; two if only opposite corners are inside and
/// the face's saddle (ac - bd) / (a + c - b - d) is not). A cell is swept along z: its slices are bilinear, so by
/// Fubini for Euler characteristics its term is the sum of the slices' terms over the special heights minus that over
/// the open intervals between them. That is -(intervals at which anything is inside), corrected by what happens at
/// the heights where two opposite strands (cell edges along z) are inside and the other two outside: there the slice
/// is split unless Q(z) = a(z) c(z) - b(z) d(z) > 0, so a split throughout gives -1 more, and joined-split-joined, a
/// tunnel, +1. Only the signs of Q at the ends of that interval and its discriminant enter. U is an open 3-manifold
/// within the padding: chi(surface) = 2 chi(U) = -2 chi_c(U).
///
/// Components. g restricted to a cell has its maxima at corners, so components of U are classes of inside grid
/// vertices, joined along edges, across faces by the saddle, and through cells where Q > 0 at some of those heights;
/// outside alike with Q < 0. Regions and the surfaces between them form a tree: surfaces = inside components +
/// cavities.
///
/// Sources: Nielson, Hamann, The asymptotic decider (1991); Chernyaev, Marching Cubes 33 (1995); Nielson, On Marching
/// Cubes (2003); Custodio et al., Practical considerations on Marching Cubes 33 (2013); Viro, Some integral calculus
/// based on Euler characteristic (1988).
struct VoxelTopology {
  std::size_t surface_components = 0;
  std::size_t inside_components = 0;
  std::size_t cavities = 0;  ///< outside components that do not reach the padding
  long euler = 0;            ///< of the surface: twice that of the inside
  double volume_mm3 = 0;     ///< inside; good to about 1e-4 of the volume of the cells that the surface crosses
  friend bool operator==(const VoxelTopology&, const VoxelTopology&) = default;
};

/// Memory grows with the runs of equal sign along i.
VoxelTopology count_topology(const Volume& volume, const Isosurface& surface);
/// The same for several surfaces in one pass over a source.
std::vector<VoxelTopology> count_topologies(const VolumeSource& source, const std::vector<Isosurface>& surfaces);

/// A connected part of the inside, or of the outside.
struct VoxelRegion {
  bool inside = false;
  std::size_t samples = 0;      ///< grid points in it (for the outermost region: those of the image)
  double volume_mm3 = 0;        ///< without what it encloses
  std::array<int, 3> low{}, high{};  ///< bounding box of its samples, voxel indices, inclusive
  std::size_t parent = 0;       ///< index of the region around it; the outermost is its own
};

/// All regions of a padded volume.
struct VoxelRegions {
  VoxelTopology topology;
  /// First the outermost region, then the inside components, then the cavities, each by falling volume.
  std::vector<VoxelRegion> regions;
};
/// Counts as count_topology does, and lists every region with its place and volume.
VoxelRegions list_regions(const Volume& volume, const Isosurface& surface);

/// Which regions filter_components changes.
struct ComponentFilter {
  bool largest_only = false;     ///< keep the inside component with the largest volume
  double min_component_mm3 = 0;  ///< remove inside components, and fill cavities, of less than this
  bool fill_cavities = false;    ///< fill every cavity
};

/// What filter_components did.
struct FilterReport {
  std::size_t kept_components = 0;
  std::size_t removed_components = 0, filled_cavities = 0;
  double removed_mm3 = 0, filled_mm3 = 0;
};

/// A volume with regions changed, and the account of it.
struct FilteredVolume {
  Volume volume;  ///< the same samples, shared, if there was nothing to do
  FilterReport report;
};

/// Takes components out of the volume (specks), and fills cavities, by setting their samples to the float next to the
/// level on its other side; a region inside a changed one becomes what surrounds it unless it is changed itself. No
/// other sample changes. A sample of a changed region has no grid neighbour in a kept region of its sign, so every
/// crossing of a kept surface with a grid edge stays where it was, to the bit. Only within cells that two regions
/// share without being joined there can the surface move, by less than the cell, and what joins what never changes
/// (none of four million random cells); a kept component may gain or lose a handle in one of about 300 cells whose
/// corners alternate and of which a part is removed: so count the filtered volume, not the original.
FilteredVolume filter_components(const Volume& volume, const Isosurface& surface, const ComponentFilter& filter);

}  // namespace delvox
