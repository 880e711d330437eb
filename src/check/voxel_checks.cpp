#include "check/voxel_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check/surface_checks.h"
#include "check/triangle_samples.h"
#include "check/triangle_tree.h"
#include "check/trilinear_field.h"

namespace delvox::check {
namespace {

constexpr double kSlack = 1 + 1e-9;

class VoxelChecker {
 public:
  VoxelChecker(const SurfaceOfMesh& mesh, const Isosurface& surface, const CheckOptions& options)
      : mesh_(mesh),
        options_(options),
        field_(*options.volume, surface),
        to_world_(options.volume->header().index_to_world),
        to_index_(to_world_.inverse()) {
    for (int axis = 0; axis < 3; ++axis) {
      voxel_mm_ = std::max(voxel_mm_, norm(to_world_.column(axis)));
      voxels_per_mm_ = std::max(voxels_per_mm_, norm(to_index_.column(axis)));
    }
  }

  void check_nodes(ReportBuilder& builder) const {
    const bool held = options_.node_tolerance_voxels.has_value() || mesh_.lies_on_isosurface;
    const double bound = options_.node_tolerance_voxels.value_or(1e-4);
    // Steepest stretch of the inverse affine: sqrt(3) times its longest column is an upper bound.
    const double tolerance = bound * kSlack + std::sqrt(3.0) * voxels_per_mm_ * mesh_.precision.displacement_mm;
    Extreme worst;
    std::vector<bool> seen(mesh_.points.size(), false);
    const auto check_node = [&](std::uint32_t v) {
      if (seen[v]) return;
      seen[v] = true;
      const double distance = node_distance_voxels(mesh_.points[v], tolerance);
      keep_largest(worst, distance, [&] { return mesh_.points[v]; });
      if (held && !(distance <= tolerance)) ++worst.violations;
    };
    for (const Triangle& t : mesh_.triangles) std::for_each(t.begin(), t.end(), check_node);
    std::for_each(mesh_.mid_nodes.begin(), mesh_.mid_nodes.end(), check_node);
    builder.bounded("nodes on the isosurface", worst, held ? std::optional<double>(bound) : std::nullopt, "voxel");
  }

  void check_surface_balls(ReportBuilder& builder) const {
    Extreme size, deviation;
    std::size_t without_ball = 0;
    for (const Triangle& t : mesh_.triangles) {
      const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
      const Point3 center = circumcenter(a, b, c);
      const Vector3 normal = cross(b - a, c - a);
      if (!is_finite(center) || !(norm(normal) > 0)) continue;  // "no degenerate triangles" names these
      const double radius = distance(center, a);
      double reach = 4 * radius + 2 * voxel_mm_;
      if (mesh_.bounds.size) {
        const double size = *mesh_.bounds.size;
        reach = std::sqrt(std::max(0.0, size * size * kSlack - radius * radius)) + 4 * displacement();
      }
      const auto height = nearest_crossing_mm(center, (1 / norm(normal)) * normal, reach);
      if (!height) {
        ++without_ball;
        if (mesh_.bounds.size) ++size.violations;
        if (mesh_.bounds.max_deviation) ++deviation.violations;
        if (mesh_.bounds.size) keep_largest(size, std::max(radius, *mesh_.bounds.size), [&] { return center; });
        continue;
      }
      keep_largest(size, std::hypot(radius, *height), [&] { return center; });
      keep_largest(deviation, *height, [&] { return center; });
      if (mesh_.bounds.max_deviation && !(*height <= *mesh_.bounds.max_deviation * kSlack + 4 * displacement())) {
        ++deviation.violations;
      }
    }
    const std::string note = without_ball == 0 ? "nearest crossing of each triangle's dual line"
                             : std::to_string(without_ball) +
                                   " triangles whose dual line does not meet the isosurface within reach";
    builder.bounded("size", size, mesh_.bounds.size, "mm", note);
    builder.bounded("deviation", deviation, mesh_.bounds.max_deviation, "mm");
  }

  // An open border comes from taking away triangles with a node in the padding: what is left ends within one
  // triangle of it.
  void check_rim(ReportBuilder& builder) const {
    if (!mesh_.open_border) return;
    double longest = 0;
    for (const Triangle& t : mesh_.triangles) {
      for (int i = 0; i < 3; ++i) {
        longest = std::max(longest, distance(mesh_.points[t[i]], mesh_.points[t[(i + 1) % 3]]));
      }
    }
    const double reach = longest * voxels_per_mm_ * std::sqrt(3.0) + 1;
    Tally astray;
    for (const auto& edge : mesh_.topology.rim) {
      for (std::uint32_t v : edge) {
        const Point3 p = to_index_(mesh_.points[v]);
        double inset = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
          inset = std::min({inset, p[axis], options_.volume->dims()[axis] - 1 - p[axis]});
        }
        if (std::abs(inset) > reach) astray.add(mesh_.points[v]);
      }
    }
    builder.count("rim on the image border", astray);
  }

  void measure_mesh_to_surface(VoxelComparison& comparison) const {
    SampledDistances sampled;
    for (const Triangle& t : mesh_.triangles) {
      const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
      const Vector3 normal = cross(b - a, c - a);
      const double double_area = norm(normal);
      if (!(double_area > 0)) continue;
      const double reach = 2 * std::max({distance(a, b), distance(b, c), distance(c, a), voxel_mm_});
      for_each_sample(a, b, c, [&](const Point3& p) {
        sampled.add(distance_to_surface_mm(p, (1 / double_area) * normal, reach), double_area);
      });
    }
    comparison.distances.mesh_to_surface_max_mm = sampled.max();
    comparison.distances.mesh_to_surface_mean_mm = sampled.mean();
  }

  void measure_surface_to_mesh(VoxelComparison& comparison) const {
    constexpr std::size_t kEnough = 200000;
    const TriangleTree tree(mesh_.points, mesh_.triangles);
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    const std::size_t crossings = field_.for_each_grid_crossing(kNone, [](const Point3&) {});
    std::size_t measured = 0;
    double sum = 0;
    field_.for_each_grid_crossing(1 + crossings / kEnough, [&](const Point3& p) {
      const double d = tree.distance(to_world_(p));
      comparison.distances.surface_to_mesh_max_mm = std::max(comparison.distances.surface_to_mesh_max_mm, d);
      sum += d;
      ++measured;
    });
    comparison.distances.surface_to_mesh_mean_mm = measured > 0 ? sum / static_cast<double>(measured) : 0;
  }

 private:
  double displacement() const { return mesh_.precision.displacement_mm; }

  // First order where that suffices; where the gradient nearly vanishes, or changes from voxel to voxel, a change of
  // sign within the tolerance proves a crossing as near.
  double node_distance_voxels(const Point3& world, double tolerance) const {
    const Point3 p = to_index_(world);
    const double outside = field_.distance_outside(p);
    if (outside > 0) return outside;
    const double g = field_.value(p);
    if (g == 0) return 0;
    const Vector3 gradient = field_.gradient(p);
    const double slope = norm(gradient), first_order = std::abs(g) / slope;
    if (first_order <= 0.5 * tolerance) return first_order;
    double nearest = std::numeric_limits<double>::infinity();
    const Vector3 uphill = slope > 0 ? (1 / slope) * gradient : Vector3{1, 0, 0};
    for (const Vector3& line : {uphill, Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}) {
      for (double sign : {1.0, -1.0}) {
        const auto crossing = field_.first_crossing(p, sign * line, std::max(2.0, 2 * tolerance));
        if (crossing) nearest = std::min(nearest, *crossing);
      }
      if (nearest <= tolerance) return nearest;
    }
    return std::isfinite(nearest) ? nearest : first_order;
  }

  // Along a line through `world`, to either side; the side that leads towards the level is walked first, so that the
  // other needs to be walked no further.
  std::optional<double> nearest_crossing_mm(const Point3& world, const Vector3& unit, double reach) const {
    const Point3 origin = to_index_(world);
    Vector3 direction = to_index_.linear(unit);
    if (field_.value(origin) * dot(field_.gradient(origin), direction) > 0) direction = -1.0 * direction;
    const auto ahead = field_.first_crossing(origin, direction, reach);
    const auto behind = field_.first_crossing(origin, -1.0 * direction, ahead.value_or(reach));
    return behind ? behind : ahead;
  }

  // The lesser of what the normal and the gradient lead to: an upper bound of the distance, sharp where it is small.
  double distance_to_surface_mm(const Point3& world, const Vector3& normal, double reach) const {
    double distance = nearest_crossing_mm(world, normal, reach).value_or(reach);
    const Vector3 steepest = to_index_.linear_transposed(field_.gradient(to_index_(world)));
    const double slope = norm(steepest);
    if (slope > 0 && distance > 0) {
      distance = std::min(distance, nearest_crossing_mm(world, (1 / slope) * steepest, distance).value_or(distance));
    }
    return distance;
  }

  const SurfaceOfMesh& mesh_;
  const CheckOptions& options_;
  TrilinearField field_;
  Affine3 to_world_, to_index_;
  double voxel_mm_ = 0;       // longest edge of a voxel
  double voxels_per_mm_ = 0;  // largest along an axis of the world
};

}  // namespace

void check_against_voxels(const SurfaceOfMesh& mesh, const Isosurface& surface, const CheckOptions& options,
                          ReportBuilder& builder, CheckReport& report) {
  const VoxelChecker checker(mesh, surface, options);
  checker.check_nodes(builder);
  checker.check_surface_balls(builder);
  checker.check_rim(builder);
  VoxelComparison comparison;
  comparison.voxels = count_topology(*options.volume, surface);
  comparison.voxel_volume_mm3 = comparison.voxels.volume_mm3;
  comparison.volume_ratio = comparison.voxel_volume_mm3 > 0 ? mesh.volume_mm3 / comparison.voxel_volume_mm3 : 0;
  checker.measure_mesh_to_surface(comparison);
  checker.measure_surface_to_mesh(comparison);
  compare_topology(mesh, "voxels", comparison.voxels.surface_components, comparison.voxels.euler, options, builder);
  report.comparison = comparison;
}

}  // namespace delvox::check
