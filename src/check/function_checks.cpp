#include "check/function_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "check/surface_checks.h"
#include "check/triangle_samples.h"
#include "check/triangle_tree.h"
#include "check/trilinear_field.h"
#include "core/parallel.h"

namespace delvox::check {
namespace {

constexpr std::size_t kChunk = 256;

class FunctionChecker {
 public:
  FunctionChecker(const SurfaceOfMesh& mesh, const CheckOptions& options)
      : mesh_(mesh), function_(*options.function), to_own_(options.function_to_world.inverse()) {}

  // To first order, as far as the function's slope goes.
  void check_nodes(ReportBuilder& builder) const {
    constexpr double kShareOfDiagonal = 1e-6;
    const double bound = kShareOfDiagonal * function_.box.diagonal();
    std::vector<std::uint32_t> nodes(mesh_.mid_nodes.begin(), mesh_.mid_nodes.end());
    for (const Triangle& t : mesh_.triangles) nodes.insert(nodes.end(), t.begin(), t.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    Extreme worst;
    for (std::uint32_t v : nodes) {
      const double distance = first_order_distance(to_own_(mesh_.points[v]));
      keep_largest(worst, distance, [&] { return mesh_.points[v]; });
      if (!(distance <= bound + 2 * mesh_.precision.displacement_mm)) ++worst.violations;
    }
    builder.bounded("nodes on the surface of the function", worst, bound, "mm", "1e-6 of the box's diagonal");
  }

  /// Positive inside, the longest side of the box in `cells` steps. Where the function is undefined is outside.
  Volume sampled(int cells) const {
    const Vector3 extent = function_.box.max - function_.box.min;
    const double step = std::max({extent.x, extent.y, extent.z}) / cells;
    VolumeHeader header;
    for (int axis = 0; axis < 3; ++axis) {
      header.dims[axis] = 1 + std::max(1, static_cast<int>(std::ceil(extent[axis] / step * (1 - 1e-12))));
      header.index_to_world.rows[axis][axis] = step;
      header.index_to_world.rows[axis][3] = function_.box.min[axis];
    }
    const auto [n, m, l] = header.dims;
    std::vector<float> samples(static_cast<std::size_t>(n) * m * l);
    for_each_chunk(samples.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin; at < end; ++at) {
        const auto row = static_cast<int>(at / n);
        const Point3 index{static_cast<double>(at % n), static_cast<double>(row % m), static_cast<double>(row / m)};
        const auto g = static_cast<float>(-function_.value(header.index_to_world(index)));
        constexpr float kFar = 1e30F;
        samples[at] = std::isnan(g) ? -kFar : std::clamp(g, -kFar, kFar);
      }
    });
    return Volume(std::move(header), samples);
  }

  void measure_mesh_to_surface(SurfaceDistances& distances) const {
    const auto parts = map_chunks(mesh_.triangles.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      SampledDistances part;
      for (std::size_t i = begin; i < end; ++i) {
        const Triangle& t = mesh_.triangles[i];
        const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
        const double double_area = norm(cross(b - a, c - a));
        for_each_sample(a, b, c, [&](const Point3& sample) {
          const Point3 p = to_own_(sample);
          part.add(distance(p, nearest(p)), double_area);
        });
      }
      return part;
    });
    SampledDistances all;
    for (const SampledDistances& part : parts) all.append(part);
    distances.mesh_to_surface_max_mm = all.max();
    distances.mesh_to_surface_mean_mm = all.mean();
  }

  void measure_surface_to_mesh(const Volume& samples, SurfaceDistances& distances) const {
    const Affine3& to_world = samples.header().index_to_world;
    std::vector<Point3> places;
    TrilinearField(samples, {0, false}).for_each_grid_crossing(1, [&](const Point3& index) {
      places.push_back(nearest(to_world(index)));
    });
    const TriangleTree tree(mesh_.points, mesh_.triangles);
    const Affine3 to_mesh = to_own_.inverse();
    double sum = 0;
    for (const Point3& p : places) {
      const double d = tree.distance(to_mesh(p));
      distances.surface_to_mesh_max_mm = std::max(distances.surface_to_mesh_max_mm, d);
      sum += d;
    }
    distances.surface_to_mesh_mean_mm = places.empty() ? 0 : sum / static_cast<double>(places.size());
  }

 private:
  double first_order_distance(const Point3& own) const {
    const double value = std::abs(function_.value(own));
    if (value == 0) return 0;
    const double distance = value / norm(function_.gradient(own));
    return std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
  }

  // By Newton's method along the gradient: the nearest point of the surface to first order. Steps that would lead away
  // are halved.
  Point3 nearest(Point3 p) const {
    constexpr int kSteps = 30;
    double value = function_.value(p);
    for (int step = 0; step < kSteps && value != 0; ++step) {
      const Vector3 gradient = function_.gradient(p);
      const double slope = squared_norm(gradient);
      if (!(slope > 0) || !std::isfinite(slope)) break;
      double share = 1;
      Point3 next = p - (value / slope) * gradient;
      while (!(std::abs(function_.value(next)) < std::abs(value)) && share > 1e-3) {
        share *= 0.5;
        next = p - (share * value / slope) * gradient;
      }
      if (!(std::abs(function_.value(next)) < std::abs(value))) break;
      p = next;
      value = function_.value(p);
    }
    return p;
  }

  const SurfaceOfMesh& mesh_;
  const ImplicitFunction& function_;
  Affine3 to_own_;  // from the mesh's frame to the function's
};

}  // namespace

void check_against_function(const SurfaceOfMesh& mesh, const CheckOptions& options, ReportBuilder& builder,
                            CheckReport& report) {
  constexpr int kCells = 128;
  const FunctionChecker checker(mesh, options);
  checker.check_nodes(builder);
  const Volume samples = checker.sampled(kCells);
  const VoxelTopology topology = count_topology(samples, {0, false});
  SurfaceComparison comparison;
  comparison.components = topology.surface_components;
  comparison.euler = topology.euler;
  checker.measure_mesh_to_surface(comparison.distances);
  checker.measure_surface_to_mesh(samples, comparison.distances);
  compare_topology(mesh, "function, sampled " + std::to_string(kCells) + " times along its box", comparison.components,
                   comparison.euler, options, builder);
  report.surface_comparison = comparison;
}

}  // namespace delvox::check
