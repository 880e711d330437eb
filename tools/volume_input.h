#pragma once

#include <optional>
#include <string>

#include "console.h"
#include "delvox/core/mesh.h"
#include "delvox/volume/level_set.h"
#include "delvox/volume/read_volume.h"
#include "delvox/volume/voxel_topology.h"
#include "patient_frame.h"

namespace delvox::tools {

/// Which volume, and what is done to it on the way in.
struct VolumeInputOptions {
  std::string path;
  ReadVolumeOptions read;
  std::string crop;     ///< "x0:x1,y0:y1,z0:z1" voxel indices, or with suffix "mm" world coordinates; empty: all
  double resample = 0;  ///< edge length of the new cubic voxels, mm; 0: as they are
  double smooth = 0;    ///< sigma of a Gaussian, mm; 0: none
};

/// Which isosurface of it, and which of its components.
struct IsosurfaceOptions {
  std::string iso = "otsu";
  bool below = false;
  bool largest = false;
  std::optional<double> min_component;  ///< mm3; default: the volume of one surface ball
  bool fill_cavities = false;
};

/// How a volume is read: --spacing, --volume-index.
void add_reading_options(CLI::App& app, VolumeInputOptions& options);
/// --crop, --resample, --smooth.
void add_preprocessing_options(CLI::App& app, VolumeInputOptions& options);
/// --iso and --below. The default of --iso is what `options` holds.
void add_isovalue_options(CLI::App& app, IsosurfaceOptions& options);
/// --largest, --min-component, --fill-cavities.
void add_component_options(CLI::App& app, IsosurfaceOptions& options);

/// A volume file and what is made of it on the way in.
struct VolumeInput {
  VolumeHeader file_header;
  FrameChange frame;
  VolumeSourcePtr source;  ///< cropped, resampled, smoothed, in this order, as it is read
};

/// The source; Ctrl-C ends a pass.
VolumeSourcePtr cancellable(VolumeSourcePtr source);

/// Opens the volume. World coordinates in --crop are those of `frame`: ras, lps or empty for the volume's own.
VolumeInput open_input(const VolumeInputOptions& options, const std::string& frame);

/// The source, held in memory if it is small: for verbs that need several passes.
VolumeSourcePtr kept_if_small(const VolumeSourcePtr& source);

/// Passes a reader's warnings on.
void tell_warnings(const VolumeHeader& header, const VolumeInputOptions& options, const Console& console);

/// An isosurface and how its value came about.
struct ChosenIsosurface {
  Isosurface surface;
  std::string sentence;
};

/// What a mesh whose nodes lie on it says of it.
void carry_isosurface(const Isosurface& surface, Mesh& mesh);

/// Resolves --iso; a point given as at:x,y,z is one of `frame`.
ChosenIsosurface choose_isosurface(const VolumeSource& source, const IsosurfaceOptions& options,
                                   const FrameChange& frame);
/// Throws NothingToMesh unless the isovalue lies in the range of the volume.
void check_isosurface(const ChosenIsosurface& chosen, const Volume& volume);

/// Takes out small components and fills cavities as the options say. `size`: radius of the surface balls, for the
/// default of --min-component. Throws NothingToMesh if nothing is left.
FilteredVolume filter_volume(const Volume& volume, const Isosurface& surface, const IsosurfaceOptions& options,
                             double size);

/// "1 component kept; 28 components (12.3 mm3) taken out, ..."; empty if there was nothing to do.
std::string describe(const FilterReport& report);

}  // namespace delvox::tools
