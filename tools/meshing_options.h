#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "console.h"
#include "delvox/core/run.h"
#include "image_material_flags.h"
#include "mesh_output.h"
#include "samples_input.h"
#include "verbs.h"
#include "volume_input.h"

namespace delvox::tools {

enum class MeshKind { kSurface, kTets };
enum class InputKind { kVolume, kPolygons, kEither, kSamples };

inline constexpr double kDefaultMinDihedralDegrees = 15;
inline constexpr double kDefaultEpsilon = 0.08;  ///< of theorem 14.2

/// Everything that `surface`, `remesh` and `tet` take. The initial values are the defaults that --help shows.
struct MeshingOptions {
  MeshKind kind = MeshKind::kTets;
  InputKind input = InputKind::kVolume;
  VolumeInputOptions volume;             ///< its path names the input, whatever its kind
  IsosurfaceOptions isosurface;
  SamplesInputOptions samples;
  std::string implicit;                  ///< a formula in place of a volume; empty: none
  std::string box;                       ///< "x0:x1,y0:y1,z0:z1", where the formula is looked at
  std::string algorithm = "delsurf";     ///< of surfaces: delsurf, delsurf1 or delsurf2
  std::string start = "seeds";           ///< seeds or persistent
  std::uint64_t seed = 0;                ///< of the random choice of persistent triangles
  std::string restricted = "bipolar";    ///< bipolar or all
  bool surface_only_after_dense = false;
  std::string size;                      ///< as size_request.h has it; empty: the domain's default, of delsurf1 lfs, of delsurf2 none
  std::optional<double> epsilon;         ///< share of lfs or curvature; unset: the default
  std::string cell_size;                 ///< a number or a volume file; empty: as size
  double grade = 0;                      ///< growth of the cell size per mm of depth
  std::size_t tets = 0;                  ///< wanted number of tets; 0: as size says
  double min_angle_degrees = 30;
  double radius_edge = 2;
  std::optional<double> min_dihedral_degrees;  ///< 0: slivers are left; unset: the default, promised only if it is met
  std::optional<double> max_deviation;   ///< mm
  std::optional<double> max_roughness_degrees;
  std::optional<double> feature_angle_degrees;  ///< of polygon surfaces; unset: sharp edges are not kept
  std::optional<double> min_ball_radius;  ///< mm; default: the domain's
  std::string border = "close";          ///< close or open
  std::string frame;                     ///< ras, lps, or empty: the input's own
  RunLimits limits;
  std::string max_memory;                ///< refuse to begin if more is forecast: "4G"; empty: no limit
  MeshOutputOptions output;
  ImageMaterialFlags image_materials;
  std::string report;                    ///< path; empty: none
  ConsoleOptions console;
};

/// Binds all flags of the verb to `options`. pre: options.kind and options.input are set.
void add_meshing_options(CLI::App& app, MeshingOptions& options);

/// Once arguments are parsed: decides what the input is, by its extension where it may be either; a .vtu holds samples if
/// a field, an interpolation or an isovalue is asked for. Throws OptionError if
/// a flag was given that has no sense for it, or if another verb is for it.
void decide_input(const CLI::App& app, MeshingOptions& options);

}  // namespace delvox::tools
