#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "delvox/volume/volume_source.h"

namespace delvox {

/// Grid that a phantom is sampled on. Shapes scale with the image: "half extent" below is half of its shortest edge,
/// min(dims * spacing) / 2, and they are centred on the image unless said otherwise.
struct PhantomOptions {
  std::array<int, 3> dims{64, 64, 64};
  Vector3 spacing{1, 1, 1};  ///< mm
  /// World directions of i, j, k; orthonormal, may be a reflection.
  std::array<Vector3, 3> direction{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Point3 center{0, 0, 0};  ///< world position of the middle of the image
  std::uint64_t seed = 1;  ///< of the noise and of "random"
  double noise = 0;        ///< standard deviation of what is added to every sample (near-normal, at most 6 of them)
  /// Values as a scanner has them: 256 steps per unit of the kind's own, whole numbers from 0 to 65535, the isovalue at
  /// 32767.5. Truth stays what it is but for that scale.
  bool uint16 = false;
};

/// A kind of phantom, as listed by `delvox phantom`.
struct PhantomKind {
  std::string name;
  std::string description;  ///< one line
  PhantomOptions defaults;
};

/// What is known of a phantom without meshing it. Inside is value >= isovalue. Unset: not known, or not a number that a
/// mesh could be held to.
struct PhantomTruth {
  double isovalue = 0;                ///< where to mesh it
  std::optional<int> components;      ///< closed surfaces, walls of cavities among them
  std::optional<int> bodies;          ///< connected pieces of the inside
  std::optional<int> euler;           ///< V - E + F of all surfaces together
  std::optional<double> volume_mm3;   ///< of the object; voxels approach it with spacing^2 unless the kind says less
  std::optional<double> area_mm2;
  std::optional<Point3> center;       ///< of kinds made of one ball, world
  std::optional<double> radius;       ///< mm
  /// The function that was sampled, without noise, and its gradient, world coordinates. Empty where there is none:
  /// "random" has neither, "shepp-logan" (piecewise constant) no gradient.
  std::function<double(const Point3&)> value;
  std::function<Vector3(const Point3&)> gradient;
};

/// All kinds: sphere, ellipsoid, torus, shells, touching-balls, plate, rod, gyroid, noisy-sphere, oblique-sphere, ramp,
/// random, border, shepp-logan.
const std::vector<PhantomKind>& phantom_kinds();

/// The default options of a kind. Throws OptionError: no such kind (the message lists them).
PhantomOptions phantom_defaults(std::string_view kind);

/// The known answers for a kind sampled with these options. Throws OptionError: no such kind; dims below 1 or too many
/// voxels; spacing or noise not positive and finite; directions not orthonormal.
PhantomTruth phantom_truth(std::string_view kind, const PhantomOptions& options);

/// A phantom whose samples are made as they are read, so it may be larger than memory. Throws as phantom_truth.
VolumeSourcePtr phantom_source(std::string_view kind, const PhantomOptions& options);

/// Samples a phantom, float32, frame RAS. The same kind and options give the same samples. Throws as phantom_truth.
Volume make_phantom(std::string_view kind, const PhantomOptions& options);
/// The same with the default options of the kind.
Volume make_phantom(std::string_view kind);

}  // namespace delvox
