#include "delvox/oracle/implicit_oracle.h"

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "oracle/bracketed_root.h"
#include "oracle/brick_field.h"
#include "oracle/clip_segment.h"
#include "oracle/domain_patches.h"
#include "oracle/voxel_seeds.h"

namespace delvox {
namespace {

/// The function as a float sample, positive inside; undefined is outside.
float sample_at(const ImplicitFunction& function, const Point3& p) {
  constexpr double kLargest = 1e30;
  const double h = -function.value(p);
  return static_cast<float>(std::isnan(h) ? -kLargest : std::clamp(h, -kLargest, kLargest));
}

/// Samples of the function at the centres of a grid over the box, as a volume to find seeds on.
Volume sample_on_grid(const ImplicitFunction& function) {
  VolumeHeader header;
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = function.box.max[axis] - function.box.min[axis];
    header.dims[axis] = static_cast<int>(std::ceil(extent / function.resolution)) + 1;
    header.index_to_world.rows[axis][axis] = extent / (header.dims[axis] - 1);
    header.index_to_world.rows[axis][3] = function.box.min[axis];
    count *= static_cast<std::size_t>(header.dims[axis]);
  }
  std::vector<float> samples;
  samples.reserve(count);
  for (int k = 0; k < header.dims[2]; ++k) {
    for (int j = 0; j < header.dims[1]; ++j) {
      for (int i = 0; i < header.dims[0]; ++i) {
        samples.push_back(sample_at(function, header.index_to_world({double(i), double(j), double(k)})));
      }
    }
  }
  return Volume(header, samples);
}

class ImplicitOracle final : public SmoothOracle {
 public:
  ImplicitOracle(const ImplicitFunction& function, std::shared_ptr<const BrickField> field,
                 const Affine3& grid_to_world)
      : function_(function), field_(std::move(field)), grid_to_world_(grid_to_world) {}

  Box3 bounds() const override { return function_.box; }
  Label label(const Point3& p) const override { return inside(p) ? 1 : 0; }
  double value(const Point3& p) const override { return -function_.value(p); }
  Vector3 gradient(const Point3& p) const override { return -1.0 * function_.gradient(p); }

  Point3 intersect(const Point3& a, const Point3& b) const override {
    Point3 low = a, high = b;
    const bool a_inside = inside(a);
    while (squared_distance(low, high) > function_.resolution * function_.resolution) {
      const Point3 middle = midpoint(low, high);
      (inside(middle) == a_inside ? low : high) = middle;
    }
    return polish(low, high);
  }

  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    std::vector<Point3> result;
    if (function_.crossings) {
      Point3 near = a, far = b;
      if (!clip_segment(function_.box, near, far)) return result;
      for (double t : function_.crossings(near, far)) result.push_back(near + t * (far - near));
      return result;
    }
    const int steps = static_cast<int>(std::min(1e6, std::ceil(distance(a, b) / (0.25 * function_.resolution)))) + 1;
    Point3 before = a;
    for (int step = 1; step <= steps; ++step) {
      const Point3 after = step == steps ? b : a + (static_cast<double>(step) / steps) * (b - a);
      if (inside(before) != inside(after)) result.push_back(polish(before, after));
      before = after;
    }
    return result;
  }

  Seeds seeds(const SizeField& size, const GoOn& go_on) const override {
    const Seeds rough = voxel_seeds(*field_, grid_to_world_, size, go_on);
    Seeds seeds;
    seeds.components = rough.components;
    for (std::size_t i = 0; i < rough.points.size(); ++i) {
      // The sampled function's surface lies within a grid step of the true one: look for that along the gradient.
      const Point3 p = grid_to_world_(rough.points[i]);
      const Vector3 direction = gradient(p);
      const double length = norm(direction);
      if (!(length > 0)) continue;
      const Vector3 step = (function_.resolution / length) * direction;
      if (inside(p - step) == inside(p + step)) continue;
      seeds.points.push_back(polish(p - step, p + step));
      seeds.component_of.push_back(rough.component_of[i]);
    }
    return seeds;
  }

  void for_each_patch(const std::function<void(const DomainPatch&)>& visit) const override {
    visit_patches(*field_, grid_to_world_, visit);
  }

  std::unique_ptr<Oracle> clone() const override { return std::make_unique<ImplicitOracle>(*this); }

 private:
  bool inside(const Point3& p) const { return function_.box.contains(p) && function_.value(p) <= 0; }

  Point3 polish(const Point3& a, const Point3& b) const {
    // Outside the box, and where the function is undefined, counts as outside: an end there takes a value of that sign.
    const auto signed_value = [&](const Point3& p) {
      const double h = -function_.value(p);
      if (std::isnan(h)) return -1.0;
      return function_.box.contains(p) || h < 0 ? h : -std::abs(h);
    };
    const Vector3 ab = b - a;
    const double value_a = signed_value(a), value_b = signed_value(b);
    const double t = bracketed_root([&](double s) { return signed_value(a + s * ab); }, 0, value_a, 1, value_b,
                                    std::min(std::abs(value_a), std::abs(value_b)));
    return a + t * ab;
  }

  ImplicitFunction function_;
  std::shared_ptr<const BrickField> field_;
  Affine3 grid_to_world_;
};

}  // namespace

void check_function(const ImplicitFunction& function) {
  if (!(function.resolution > 0)) throw OptionError("implicit function: the resolution must be positive");
  for (int axis = 0; axis < 3; ++axis) {
    if (!(function.box.max[axis] - function.box.min[axis] > function.resolution)) {
      throw OptionError("implicit function: the box must be wider than the resolution in each direction");
    }
  }
}

std::unique_ptr<SmoothOracle> make_implicit_oracle(const ImplicitFunction& function) {
  check_function(function);
  const Volume samples = sample_on_grid(function);
  const LevelSet zero(Isosurface{0, false});
  if (!zero.inside(samples.max()) || zero.inside(samples.min())) {
    throw NothingToMesh("implicit function: no change of sign in the box at this resolution; widen the box or refine");
  }
  auto field = std::make_shared<const BrickField>(samples, zero);
  Affine3 padding;
  for (int axis = 0; axis < 3; ++axis) padding.rows[axis][3] = -1;
  return std::make_unique<ImplicitOracle>(function, std::move(field),
                                          compose(samples.header().index_to_world, padding));
}

}  // namespace delvox
