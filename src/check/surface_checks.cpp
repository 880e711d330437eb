#include "check/surface_checks.h"

#include <algorithm>
#include <cmath>

#include "check/triangle_tree.h"
#include "core/parallel.h"
#include "delvox/core/merge_points.h"

namespace delvox::check {
namespace {

struct Distances {
  double max = 0, mean = 0;
};

/// From points spread about evenly over the triangles, corners and edges included, to the tree; the mean is by area.
Distances distances(const std::vector<Point3>& points, std::span<const Triangle> triangles, const TriangleTree& tree) {
  constexpr double kSamples = 50000;
  const auto area_of = [&](const Triangle& t) {
    return 0.5 * norm(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
  };
  double area = 0;
  for (const Triangle& t : triangles) area += area_of(t);
  struct Part {
    double max = 0, weighted = 0;
  };
  const auto parts = map_chunks(triangles.size(), 256, [&](std::size_t begin, std::size_t end) {
    Part part;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = triangles[i];
      const double share = area > 0 ? area_of(t) / area : 0;
      const int steps = std::max(2, static_cast<int>(std::ceil(std::sqrt(2 * kSamples * share))));
      double sum = 0;
      for (int u = 0; u <= steps; ++u) {
        for (int v = 0; v <= steps - u; ++v) {
          const double s = double(u) / steps, r = double(v) / steps;
          const double d = tree.distance((1 - s - r) * points[t[0]] + s * points[t[1]] + r * points[t[2]]);
          part.max = std::max(part.max, d);
          sum += d;
        }
      }
      part.weighted += share * sum / (0.5 * (steps + 1) * (steps + 2));
    }
    return part;
  });
  Distances result;
  for (const Part& part : parts) {
    result.max = std::max(result.max, part.max);
    result.mean += part.weighted;
  }
  return result;
}

}  // namespace

void compare_topology(const SurfaceOfMesh& mesh, const std::string& other, std::size_t components, long euler,
                      const CheckOptions& options, ReportBuilder& builder) {
  const std::size_t own = mesh.topology.components.size();
  const std::string name = "topology of the " + other;
  const std::string note = "mesh: " + std::to_string(own) + " components, Euler number " +
                           std::to_string(mesh.topology.euler) + "; " + other + ": " + std::to_string(components) +
                           ", " + std::to_string(euler);
  const bool equal = own == components && mesh.topology.euler == euler;
  if (options.require_same_topology) {
    Tally faults;
    if (!equal) faults.add(mesh.points[mesh.triangles[0][0]]);
    builder.count(name, faults, note);
  } else {
    builder.not_applicable(name, note + (equal ? " (equal)" : " (different; not required)"));
  }
}

void check_against_surface(const SurfaceOfMesh& mesh, const CheckOptions& options, ReportBuilder& builder,
                           CheckReport& report) {
  const SurfaceMesh input = with_equal_points_merged(*options.surface);
  const SurfaceTopology topology = surface_topology(input.points, input.triangles);
  const TriangleTree of_input(input.points, input.triangles), of_mesh(mesh.points, mesh.triangles);
  Extreme nodes;
  std::vector<bool> met(mesh.points.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (std::uint32_t v : t) {
      if (met[v]) continue;
      met[v] = true;
      const double d = of_input.distance(mesh.points[v]);
      if (!nodes.any || d > nodes.value) nodes = {d, true, mesh.points[v], 0};
    }
  }
  builder.bounded("nodes on the surface", nodes, std::nullopt, "mm", "largest distance of a boundary node");
  compare_topology(mesh, "surface", topology.components.size(), topology.euler, options, builder);
  SurfaceComparison comparison;
  comparison.components = topology.components.size();
  comparison.euler = topology.euler;
  const Distances there = distances(mesh.points, mesh.triangles, of_input);
  const Distances back = distances(input.points, input.triangles, of_mesh);
  comparison.distances = {there.max, there.mean, back.max, back.mean};
  report.surface_comparison = comparison;
}

}  // namespace delvox::check
