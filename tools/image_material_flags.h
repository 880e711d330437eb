#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "delvox/meshing/image_materials.h"

namespace CLI {
class App;
}

namespace delvox::tools {

/// Flags that make materials from the samples of the volume.
struct ImageMaterialFlags {
  std::string hu_density;  ///< "a,b": density in g/cm3 = a + b * sample; empty: no materials from the image
  std::string modulus;     ///< name of a law, or "E=a*rho^b"
  std::size_t bins = 20;
  int peel = 0;  ///< voxels
  double poisson_ratio = 0.3;
};

/// --hu-density, --modulus, --material-bins, --peel, --poisson.
void add_image_material_options(CLI::App& app, ImageMaterialFlags& flags);

/// What the flags ask for; nothing without --hu-density. Throws OptionError.
std::optional<ImageMaterialOptions> parse_image_materials(const ImageMaterialFlags& flags);

}  // namespace delvox::tools
