#pragma once

#include <array>
#include <string_view>

#include "delvox/volume/volume_source.h"

namespace delvox {

// What may be done to a volume before meshing. Samples stay where they were in the world: only the affine tells where,
// so it changes with the grid. Same result for any number of threads. Sources made from sources stream: they keep only
// the slices that they need at a time. The same for a Volume gives a new Volume.

/// Voxels [begin, end) along i, j, k.
struct IndexBox {
  std::array<int, 3> begin{0, 0, 0};
  std::array<int, 3> end{0, 0, 0};
  friend bool operator==(const IndexBox&, const IndexBox&) = default;
};

/// The part of a volume inside the box, which is clipped to the image.
/// Throws NothingToMesh: nothing is left.
VolumeSourcePtr crop(const VolumeSourcePtr& source, const IndexBox& box);
/// The same for a whole volume.
Volume crop(const Volume& volume, const IndexBox& box);

/// The smallest index box around a world box (mm, the volume's frame) cut with the image: all voxels whose centers lie
/// in the world box, on an oblique image also others. Empty if they do not meet. pre: the world box is finite or empty.
IndexBox index_box(const VolumeHeader& header, const Box3& world);

/// What `--crop` takes: "x0:x1,y0:y1,z0:z1", voxel indices, half open; with the suffix "mm" world coordinates, closed.
/// A bound left out ("10:,:,:50") is the image's own. Clipped to the image; may be empty (crop refuses that).
/// Throws OptionError: the text does not parse.
IndexBox parse_crop(const VolumeHeader& header, std::string_view text);

/// How smooth() works.
struct SmoothOptions {
  double sigma_mm = 0;  ///< standard deviation of the Gaussian; 0 leaves the volume as it is
};

/// Gaussian smoothing along each grid axis with sigma / spacing voxels, truncated at 4 sigma, the kernel normalised,
/// edge samples repeated outside (as scipy.ndimage.gaussian_filter, mode "nearest"). A sheared affine is treated as if
/// its axes were orthogonal.
/// Throws OptionError: sigma negative, not finite, or beyond the extent of the image.
VolumeSourcePtr smooth(const VolumeSourcePtr& source, const SmoothOptions& options);
/// The same for a whole volume.
Volume smooth(const Volume& volume, const SmoothOptions& options);

/// How resample() works.
struct ResampleOptions {
  double spacing_mm = 0;  ///< of the result along all three axes
  bool prefilter = true;  ///< smooth first along axes that get coarser
};

/// Trilinear interpolation on an isotropic grid with the same axis directions. The field of view (voxels with their
/// full extent) is covered and keeps its middle, so the outermost voxels stick out by under half a new voxel; beyond
/// the first and last voxel centers the edge samples are repeated. Along axes that get coarser, detail that the new
/// grid cannot hold is smoothed away first by a Gaussian whose full width at half maximum is sqrt(new^2 - old^2)
/// (Cardoso et al., MICCAI 2015).
/// Throws OptionError: spacing not positive and finite, more than 2^31 voxels.
VolumeSourcePtr resample(const VolumeSourcePtr& source, const ResampleOptions& options);
/// The same for a whole volume.
Volume resample(const Volume& volume, const ResampleOptions& options);

/// The same samples with the order along one axis (0 to 2) reversed, at the same world positions.
Volume flip_axis(const Volume& volume, int axis);

/// The same samples with axis a of the result being axis order[a] of the volume, at the same world positions.
/// pre: order is a permutation of 0, 1, 2.
Volume permute_axes(const Volume& volume, const std::array<int, 3>& order);

}  // namespace delvox
