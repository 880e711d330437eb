#include "delvox/volume/phantom.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "volume/phantom_shapes.h"

namespace delvox {
namespace {

using TruthMaker = PhantomTruth (*)(const PhantomSetting&);

struct Row {
  PhantomKind kind;
  TruthMaker make_truth;
};

PhantomOptions oblique_defaults() {
  PhantomOptions options;
  options.dims = {72, 60, 40};
  options.spacing = {0.7, 0.9, 1.6};
  options.direction = {{{6.0 / 7, -3.0 / 7, -2.0 / 7}, {2.0 / 7, 6.0 / 7, -3.0 / 7}, {3.0 / 7, 2.0 / 7, 6.0 / 7}}};
  options.center = {12.5, -45.25, 78.125};
  return options;
}

PhantomOptions with_noise(double noise) {
  PhantomOptions options;
  options.noise = noise;
  return options;
}

PhantomOptions with_dims(int n) {
  PhantomOptions options;
  options.dims = {n, n, n};
  return options;
}

const std::vector<Row>& rows() {
  static const std::vector<Row> table{
      {{"sphere", "ball, signed distance, radius 0.625 of the half extent", {}}, sphere_truth},
      {{"ellipsoid", "ellipsoid, semi-axes 0.75, 0.55, 0.4 of the half extent along world x, y, z", {}},
       ellipsoid_truth},
      {{"torus", "torus, radii 0.55 and 0.2 of the half extent, tilted axis", {}}, torus_truth},
      {{"shells", "ball with a concentric cavity that holds a smaller ball: three nested surfaces", {}}, shells_truth},
      {{"touching-balls", "two balls that touch in one point between two voxels", {}}, touching_balls_truth},
      {{"plate", "round plate two voxels thick, tilted, rounded rim", {}}, plate_truth},
      {{"rod", "rod 2.5 voxels thick, tilted, rounded ends", {}}, rod_truth},
      {{"gyroid", "gyroid clipped by a ball: exactly half of the ball is inside", {}}, gyroid_truth},
      {{"noisy-sphere", "ball with contrast at its surface only, under noise: specks everywhere", with_noise(1)},
       noisy_sphere_truth},
      {{"oblique-sphere", "ball off the middle of an oblique image with spacing 0.7 x 0.9 x 1.6 mm",
        oblique_defaults()},
       oblique_sphere_truth},
      {{"ramp", "linear in world coordinates, 2x + 3y + 6z from the middle: the surface is a plane", {}}, ramp_truth},
      {{"random", "random integers 0 to 3: thousands of ties at isovalue 2", with_dims(32)}, random_truth},
      {{"border", "ball cut by the image border (+i side)", {}}, border_truth},
      {{"shepp-logan", "3D Shepp-Logan head, modified contrast, point-sampled: head with two ventricles",
        with_dims(128)},
       shepp_logan_truth}};
  return table;
}

const Row& find_row(std::string_view name) {
  std::string known;
  for (const Row& row : rows()) {
    if (row.kind.name == name) return row;
    known += (known.empty() ? "" : ", ") + row.kind.name;
  }
  throw OptionError("phantom kind '" + std::string(name) + "' is unknown; choose one of " + known);
}

void check_options(const PhantomOptions& options) {
  constexpr double kMaxVoxels = 1099511627776.0;
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (options.dims[axis] < 1) throw OptionError("phantom: a dimension is below 1; give three positive numbers");
    voxels *= options.dims[axis];
    if (!(options.spacing[axis] > 0) || !std::isfinite(options.spacing[axis])) {
      throw OptionError("phantom: spacing must be positive; give millimetres");
    }
    for (int other = 0; other <= axis; ++other) {
      const double wanted = axis == other ? 1 : 0;
      if (!(std::abs(dot(options.direction[axis], options.direction[other]) - wanted) < 1e-9)) {
        throw OptionError("phantom: directions must be orthonormal; give three orthogonal unit vectors");
      }
    }
  }
  if (voxels > kMaxVoxels) throw OptionError("phantom: more than 2^40 voxels; choose smaller dimensions");
  if (!is_finite(options.center)) throw OptionError("phantom: the center is not finite; give millimetres");
  if (!(options.noise >= 0) || !std::isfinite(options.noise)) {
    throw OptionError("phantom: noise must not be negative; give a standard deviation");
  }
}

VolumeHeader make_header(const PhantomOptions& options) {
  VolumeHeader header;
  header.dims = options.dims;
  header.frame = Frame::kRas;
  header.format = "phantom";
  header.sample_type = options.uint16 ? "uint16" : "float32";
  Point3 origin = options.center;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 column = options.spacing[axis] * options.direction[axis];
    for (int row = 0; row < 3; ++row) header.index_to_world.rows[row][axis] = column[row];
    origin = origin - (0.5 * (options.dims[axis] - 1)) * column;
  }
  for (int row = 0; row < 3; ++row) header.index_to_world.rows[row][3] = origin[row];
  return header;
}

/// splitmix64 (Steele, Lea, Flood 2014): one hash per voxel, so the samples do not depend on the order of visits.
std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

/// Sum of twelve uniform numbers minus six: mean 0, variance 1, and unlike Box-Muller no libm, so the same everywhere.
double near_normal(std::uint64_t key) {
  double sum = 0;
  for (int word = 0; word < 3; ++word) {
    key = splitmix64(key);
    for (int shift = 0; shift < 64; shift += 16) sum += (static_cast<double>((key >> shift) & 0xFFFF) + 0.5) / 65536;
  }
  return sum - 6;
}

constexpr double kStepsPerUnit = 256, kIsovalueOfSteps = 32767.5;

/// Turns the units of a truth into steps.
PhantomTruth in_steps(PhantomTruth truth) {
  const auto value = truth.value;
  const auto gradient = truth.gradient;
  const double isovalue = truth.isovalue;
  if (value) {
    truth.value = [=](const Point3& p) { return kStepsPerUnit * (value(p) - isovalue) + kIsovalueOfSteps; };
  }
  if (gradient) truth.gradient = [=](const Point3& p) { return kStepsPerUnit * gradient(p); };
  truth.isovalue = kIsovalueOfSteps;
  return truth;
}

class PhantomReader final : public SliceReader {
 public:
  PhantomReader(const PhantomTruth& truth, const PhantomOptions& options, const Affine3& index_to_world)
      : truth_(truth), options_(options), index_to_world_(index_to_world), stream_(splitmix64(options.seed)) {}

  void read(int count, float* out) override {
    const int columns = options_.dims[0], rows = options_.dims[1];
    tbb::parallel_for(0, rows * count, [&](int row) {
      make_row(row % rows, next_ + row / rows, out + static_cast<std::size_t>(row) * columns);
    });
    next_ += count;
  }

 private:
  void make_row(int j, int k, float* out) const {
    std::size_t index = (static_cast<std::size_t>(k) * options_.dims[1] + j) * options_.dims[0];
    for (int i = 0; i < options_.dims[0]; ++i, ++index) {
      const std::uint64_t key = splitmix64(stream_ ^ index);
      // Only "random" has no function behind it.
      double value = truth_.value ? truth_.value(index_to_world_({1.0 * i, 1.0 * j, 1.0 * k}))
                                  : static_cast<double>(key >> 62) * (options_.uint16 ? kStepsPerUnit : 1);
      if (options_.noise > 0) value += options_.noise * (options_.uint16 ? kStepsPerUnit : 1) * near_normal(key);
      if (options_.uint16) value = std::clamp(std::round(value), 0.0, 65535.0);
      out[i] = static_cast<float>(value);
    }
  }

  const PhantomTruth& truth_;
  const PhantomOptions& options_;
  Affine3 index_to_world_;
  std::uint64_t stream_;
  int next_ = 0;
};

class PhantomSource final : public VolumeSource {
 public:
  PhantomSource(VolumeHeader header, PhantomTruth truth, const PhantomOptions& options)
      : VolumeSource(std::move(header)), truth_(std::move(truth)), options_(options) {}
  std::unique_ptr<SliceReader> start() const override {
    return std::make_unique<PhantomReader>(truth_, options_, header().index_to_world);
  }

 private:
  PhantomTruth truth_;
  PhantomOptions options_;
};

}  // namespace

const std::vector<PhantomKind>& phantom_kinds() {
  static const std::vector<PhantomKind> kinds = [] {
    std::vector<PhantomKind> list;
    for (const Row& row : rows()) list.push_back(row.kind);
    return list;
  }();
  return kinds;
}

PhantomOptions phantom_defaults(std::string_view kind) { return find_row(kind).kind.defaults; }

PhantomTruth phantom_truth(std::string_view kind, const PhantomOptions& options) {
  const Row& row = find_row(kind);
  check_options(options);
  const PhantomTruth truth = row.make_truth(PhantomSetting(options));
  return options.uint16 ? in_steps(truth) : truth;
}

VolumeSourcePtr phantom_source(std::string_view kind, const PhantomOptions& options) {
  const PhantomTruth truth = phantom_truth(kind, options);
  return std::make_shared<PhantomSource>(make_header(options), truth, options);
}

Volume make_phantom(std::string_view kind, const PhantomOptions& options) { return load(*phantom_source(kind, options)); }

Volume make_phantom(std::string_view kind) { return make_phantom(kind, phantom_defaults(kind)); }

}  // namespace delvox
