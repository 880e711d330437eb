#pragma once

#include <cstddef>

#include "delvox/core/density_law.h"
#include "delvox/core/mesh.h"
#include "delvox/volume/volume.h"

namespace delvox {

/// How the samples of a volume become materials.
struct ImageMaterialOptions {
  double density_offset = 0;  ///< density in g/cm3 = offset + slope * sample
  double density_slope = 0;
  DensityLaw law;
  std::size_t bins = 20;       ///< most materials there may be
  double poisson_ratio = 0.3;  ///< of all of them
};

/// What came of it.
struct ImageMaterialReport {
  double least_mpa = 0, greatest_mpa = 0;  ///< mean modulus of a tet
  double mean_mpa = 0;                     ///< over the volume of the mesh
  double thin_share = 0;  ///< of the volume, where the density was below 0.01 g/cm3 and was taken for it
};

/// Gives each tet the mean over its volume of the modulus at each point, the volume interpolated trilinearly (beyond
/// its voxel centres by the nearest), by quadrature as fine as two voxels. Tets are then put into bins of equal width;
/// each bin becomes a region with a material that has the bin's mean modulus and density, so that the integral of the
/// modulus over the mesh stays what it is. Edges count as straight. Replaces regions and materials. pre: mesh in the
/// frame of the volume, one region, bins >= 1. Throws OptionError if a modulus comes out as infinite or zero.
ImageMaterialReport assign_image_materials(TetMesh& mesh, const Volume& volume, const ImageMaterialOptions& options);

}  // namespace delvox
