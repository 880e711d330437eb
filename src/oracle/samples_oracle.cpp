#include "delvox/oracle/samples_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "delvox/core/errors.h"
#include "oracle/bracketed_root.h"
#include "oracle/clip_segment.h"
#include "oracle/polygon_seeds.h"
#include "oracle/samples_interpolation.h"
#include "oracle/samples_surface.h"

namespace delvox {

/// What copies share: nothing of it changes.
struct SampleField::Impl {
  explicit Impl(Samples given) : samples(std::move(given)), triangulation(samples.points) {
    for (std::uint32_t c = 0; c < triangulation.finite_count(); ++c) hull_mm3 += triangulation.six_volumes(c) / 6;
  }

  Samples samples;
  SampleTriangulation triangulation;
  double hull_mm3 = 0;
};

namespace {

/// Ties are moved by this share of the range of the values.
constexpr double kNudge = 1e-9;

/// Per sample how far inside it lies, in units of the values: positive inside, never 0.
std::vector<double> levels_of(const std::vector<double>& values, const Isosurface& surface) {
  const double sign = surface.below ? -1 : 1;
  double level = sign * surface.isovalue;
  double lowest = Box3::kInfinity, highest = -Box3::kInfinity, highest_outside = -Box3::kInfinity;
  bool tied = false;
  for (double value : values) {
    const double g = sign * value;
    lowest = std::min(lowest, g);
    highest = std::max(highest, g);
    tied |= g == level;
    if (g < level) highest_outside = std::max(highest_outside, g);
  }
  if (highest < level) throw NothingToMesh("no sample is inside; choose another --iso, see delvox info");
  if (tied) {
    const double range = highest > lowest ? highest - lowest : std::max(1.0, std::abs(level));
    const double nudged = level - std::min(0.5 * (level - highest_outside), kNudge * range);
    level = nudged < level ? nudged : std::nextafter(level, -Box3::kInfinity);
  }
  std::vector<double> levels;
  levels.reserve(values.size());
  for (double value : values) levels.push_back(sign * value - level);
  return levels;
}

PolygonSurface linear_surface(const SampleTriangulation& triangulation, const std::vector<double>& levels) {
  return samples_surface(triangulation, levels, [&](std::uint32_t, std::uint32_t v, std::uint32_t w) {
    return linear_place(triangulation, levels, v, w);
  });
}

/// A closed surface has three edges for every two triangles.
SurfaceTopology topology_of(const PolygonSurface& surface) {
  const auto points = static_cast<long>(surface.points.size()), triangles = static_cast<long>(surface.triangles.size());
  return {surface.components, points - triangles / 2};
}

/// What clones share.
struct Domain {
  Domain(std::shared_ptr<const SampleField::Impl> of_field, const Isosurface& isosurface, Interpolation how)
      : field(std::move(of_field)),
        triangulation(field->triangulation),
        levels(levels_of(field->samples.values, isosurface)),
        interpolation(how),
        spacing(std::cbrt(field->hull_mm3 / static_cast<double>(levels.size()))) {
    const Box3& box = triangulation.box();
    const Vector3 margin = (0.01 * box.diagonal()) * Vector3{1, 1, 1};
    bounds = {box.min - margin, box.max + margin};
    const auto [low, high] = std::minmax_element(levels.begin(), levels.end());
    range = std::max(*high - *low, *high);
    surface = samples_surface(triangulation, levels, [this](std::uint32_t cell, std::uint32_t v, std::uint32_t w) {
      return place_on_edge(cell, v, w);
    });
  }

  double level_at(std::uint32_t cell, const Point3& p) const {
    return interpolation == Interpolation::kLinear ? linear_value(triangulation, levels, cell, p)
                                                   : natural_level(triangulation, levels, cell, p);
  }

  /// A root of the level on a segment, as a share of it, between shares s and t where it has the values at_s and at_t.
  /// pre: at(share) lies in the cell.
  template <class At>
  double root(std::uint32_t cell, const At& at, double s, double at_s, double t, double at_t) const {
    // Natural neighbour coordinates have eleven digits: no use to look for more.
    const double digits = interpolation == Interpolation::kLinear ? 1 : 1e-11 / std::numeric_limits<double>::epsilon();
    const double scale = digits * std::max(std::abs(at_s), std::abs(at_t));
    return bracketed_root([&](double share) { return level_at(cell, at(share)); }, s, at_s, t, at_t, scale);
  }

  Point3 place_on_edge(std::uint32_t cell, std::uint32_t v, std::uint32_t w) const {
    if (interpolation == Interpolation::kLinear) return linear_place(triangulation, levels, v, w);
    const Point3 &p = triangulation.points()[v], &q = triangulation.points()[w];
    const auto at = [&](double share) { return p + share * (q - p); };
    return at(root(cell, at, 0, levels[v], 1, levels[w]));
  }

  std::shared_ptr<const SampleField::Impl> field;
  const SampleTriangulation& triangulation;
  std::vector<double> levels;
  Interpolation interpolation;
  double spacing, range;
  Box3 bounds;
  PolygonSurface surface;  // of the linear interpolant; for natural neighbours its points lie on theirs, no others
};

class SamplesOracle final : public Oracle {
 public:
  explicit SamplesOracle(std::shared_ptr<const Domain> domain) : domain_(std::move(domain)) {}

  Box3 bounds() const override { return domain_->bounds; }

  Label label(const Point3& p) const override {
    if (!domain_->triangulation.box().contains(p)) return 0;
    const std::uint32_t cell = domain_->triangulation.locate(p);
    return domain_->triangulation.finite(cell) && domain_->level_at(cell, p) > 0 ? 1 : 0;
  }

  Point3 intersect(const Point3& a, const Point3& b) const override {
    Point3 near = a, far = b;
    if (!clip_segment(domain_->bounds, near, far)) return bisect(a, b);
    const std::vector<double> shares = crossings(near, far, 1);
    return shares.empty() ? bisect(a, b) : at(near, far, shares.front());
  }

  std::vector<Point3> intersect_all(const Point3& a, const Point3& b) const override {
    Point3 near = a, far = b;
    std::vector<Point3> points;
    if (!clip_segment(domain_->bounds, near, far)) return points;
    for (double share : crossings(near, far, std::numeric_limits<std::size_t>::max()))
      points.push_back(at(near, far, share));
    return points;
  }

  Seeds seeds(const SizeField& size, const GoOn& go_on) const override {
    const Seeds rough = polygon_seeds(domain_->surface, size, go_on);
    if (domain_->interpolation == Interpolation::kLinear) return rough;
    Seeds seeds;
    seeds.components = rough.components;
    for (std::size_t i = 0; i < rough.points.size(); ++i) {
      if (i % 1024 == 1023 && !go_on()) break;
      const auto p = moved_to_surface(rough.points[i]);
      if (!p) continue;
      seeds.points.push_back(*p);
      seeds.component_of.push_back(rough.component_of[i]);
    }
    return seeds;
  }

  std::optional<SurfaceTopology> topology() const override {
    if (domain_->interpolation != Interpolation::kLinear) return std::nullopt;
    return topology_of(domain_->surface);
  }

  void for_each_patch(const std::function<void(const DomainPatch&)>& visit) const override {
    visit_samples_patches(domain_->triangulation, domain_->levels, domain_->spacing, visit);
  }

  std::unique_ptr<Oracle> clone() const override { return std::make_unique<SamplesOracle>(domain_); }

 private:
  static Point3 at(const Point3& a, const Point3& b, double share) { return share == 1 ? b : a + share * (b - a); }

  /// The first `wanted` of them, tet by tet. The linear interpolant changes its sign at most once in each; of natural
  /// neighbours' the sign is looked at in four places.
  std::vector<double> crossings(const Point3& a, const Point3& b, std::size_t wanted) const {
    const int steps = domain_->interpolation == Interpolation::kLinear ? 1 : 4;
    const SampleTriangulation::Passage passage = domain_->triangulation.passage(a, b);
    std::vector<double> shares;
    if (passage.stretches.empty()) return shares;
    const auto place = [&](double share) { return at(a, b, share); };
    double before = passage.stretches.front().from;
    double value = domain_->level_at(passage.stretches.front().cell, place(before));
    if (!passage.starts_inside && value > 0) shares.push_back(before);
    for (const auto& stretch : passage.stretches) {
      if (shares.size() >= wanted) return shares;
      for (int step = 1; step <= steps; ++step) {
        const double after = step == steps ? stretch.to : stretch.from + (stretch.to - stretch.from) * step / steps;
        if (!(after > before)) continue;
        const double next = domain_->level_at(stretch.cell, place(after));
        if ((value > 0) != (next > 0)) shares.push_back(domain_->root(stretch.cell, place, before, value, after, next));
        before = after;
        value = next;
      }
    }
    if (!passage.ends_inside && value > 0) shares.push_back(before);
    return shares;
  }

  /// Where rounding hides the crossing from the walk, as at an end that is on the surface itself.
  Point3 bisect(Point3 a, Point3 b) const {
    const Label of_a = label(a);
    while (true) {
      const Point3 middle = midpoint(a, b);
      if (middle == a || middle == b) return of_a != 0 ? a : b;
      (label(middle) == of_a ? a : b) = middle;
    }
  }

  /// The place on natural neighbours' surface that one on the linear one's stands for, if it is near.
  std::optional<Point3> moved_to_surface(const Point3& p) const {
    const SampleTriangulation& t = domain_->triangulation;
    std::uint32_t cell = t.locate(p);
    if (!t.finite(cell)) cell = t.cells()[cell].neighbors[3];
    const double level = domain_->level_at(cell, p);
    if (std::abs(level) <= kNudge * domain_->range || (level > 0 && on_hull(cell, p))) return p;
    const Vector3 uphill = gradient(cell);
    const double slope = norm(uphill), farthest = 0.5 * domain_->spacing;
    if (!(slope > 0)) return std::nullopt;
    const Point3 end = p + ((level > 0 ? -farthest : farthest) / slope) * uphill;
    const std::vector<Point3> found = intersect_all(p, end);
    if (found.empty()) return std::nullopt;
    return found.front();
  }

  bool on_hull(std::uint32_t cell, const Point3& p) const {
    const SampleTriangulation& t = domain_->triangulation;
    for (int i = 0; i < 4; ++i) {
      if (t.finite(t.cells()[cell].neighbors[i])) continue;
      const Point3& q = t.corner(cell, kTetFaces[i][0]);
      const Vector3 normal = cross(t.corner(cell, kTetFaces[i][1]) - q, t.corner(cell, kTetFaces[i][2]) - q);
      if (std::abs(dot(normal, p - q)) <= kNudge * domain_->spacing * norm(normal)) return true;
    }
    return false;
  }

  /// Of the linear interpolant.
  Vector3 gradient(std::uint32_t cell) const {
    const SampleTriangulation& t = domain_->triangulation;
    Vector3 sum;
    for (int i = 0; i < 4; ++i) {
      const Point3& q = t.corner(cell, kTetFaces[i][0]);
      const Vector3 inward = cross(t.corner(cell, kTetFaces[i][2]) - q, t.corner(cell, kTetFaces[i][1]) - q);
      sum = sum + domain_->levels[t.cells()[cell].vertices[i]] * inward;
    }
    return (1 / t.six_volumes(cell)) * sum;
  }

  std::shared_ptr<const Domain> domain_;
};

}  // namespace

SampleField::SampleField(Samples samples) : impl_(std::make_shared<const Impl>(std::move(samples))) {}

const Samples& SampleField::samples() const {
  return impl_->samples;
}

std::size_t SampleField::tet_count() const {
  return impl_->triangulation.finite_count();
}

double SampleField::hull_mm3() const {
  return impl_->hull_mm3;
}

double SampleField::spacing() const {
  return std::cbrt(impl_->hull_mm3 / static_cast<double>(impl_->samples.points.size()));
}

double SampleField::value(const Point3& p, Interpolation interpolation) const {
  const SampleTriangulation& t = impl_->triangulation;
  const std::uint32_t cell = t.box().contains(p) ? t.locate(p) : SampleTriangulation::kNone;
  if (!t.finite(cell)) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double>& values = impl_->samples.values;
  return interpolation == Interpolation::kLinear ? linear_value(t, values, cell, p) : natural_value(t, values, cell, p);
}

SampleField::Inside SampleField::inside(const Isosurface& surface) const {
  const std::vector<double> levels = levels_of(impl_->samples.values, surface);
  const SampleTriangulation& t = impl_->triangulation;
  Inside inside;
  for (std::uint32_t c = 0; c < t.finite_count(); ++c) {
    inside.mm3 += inside_mm3_of(t, levels, c);
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t v = t.cells()[c].vertices[i];
      if (!(levels[v] > 0)) continue;
      for (int face = 0; face < 4; ++face) inside.on_hull |= face != i && !t.finite(t.cells()[c].neighbors[face]);
      inside.box.extend(t.corner(c, i));
      for (std::uint32_t w : t.cells()[c].vertices) {
        if (!(levels[w] > 0)) inside.box.extend(linear_place(t, levels, v, w));
      }
    }
  }
  return inside;
}

std::unique_ptr<Oracle> make_samples_oracle(const SampleField& field, const Isosurface& surface,
                                            Interpolation interpolation) {
  return std::make_unique<SamplesOracle>(std::make_shared<const Domain>(field.impl(), surface, interpolation));
}

VoxelTopology count_samples_topology(const SampleField& field, const Isosurface& surface) {
  const PolygonSurface polygons =
      linear_surface(field.impl()->triangulation, levels_of(field.samples().values, surface));
  std::vector<double> mm3(polygons.components, 0);
  const Point3 origin = field.impl()->triangulation.box().center();
  for (std::uint32_t t = 0; t < polygons.triangles.size(); ++t) {
    const Vector3 a = polygons.corner(t, 0) - origin, b = polygons.corner(t, 1) - origin;
    mm3[polygons.component_of[t]] += dot(cross(a, b), polygons.corner(t, 2) - origin) / 6;
  }
  VoxelTopology topology;
  topology.surface_components = polygons.components;
  topology.cavities = static_cast<std::size_t>(std::count_if(mm3.begin(), mm3.end(), [](double v) { return v < 0; }));
  topology.inside_components = topology.surface_components - topology.cavities;
  topology.euler = topology_of(polygons).euler;
  topology.volume_mm3 = std::accumulate(mm3.begin(), mm3.end(), 0.0);
  return topology;
}

SurfaceMesh samples_isosurface(const SampleField& field, const Isosurface& surface) {
  PolygonSurface polygons = linear_surface(field.impl()->triangulation, levels_of(field.samples().values, surface));
  SurfaceMesh mesh{std::move(polygons.points), std::move(polygons.triangles), {}, {}};
  mesh.info.frame = field.samples().frame;
  return mesh;
}

}  // namespace delvox
