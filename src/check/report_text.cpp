#include <algorithm>
#include <cstdio>

#include "delvox/check/check_mesh.h"

namespace delvox {
namespace {

template <class... Args>
std::string format(const char* pattern, Args... args) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, pattern, args...);
  return buffer;
}

std::string with_unit(double value, const std::string& unit) {
  return format("%.6g", value) + (unit.empty() ? "" : " " + unit);
}

std::string line_of(const Check& check, std::size_t name_width) {
  const char* mark = check.status == CheckStatus::kPassed   ? "ok    "
                     : check.status == CheckStatus::kFailed ? "FAILED"
                                                            : "-     ";
  std::string line = format("%s  %-*s", mark, static_cast<int>(name_width), check.name.c_str());
  const bool is_count = check.bound == 0.0 && check.unit.empty();
  if (check.status != CheckStatus::kNotApplicable || check.where) {
    line += "  " + with_unit(check.measured, check.unit);
    if (check.bound && !is_count) line += format(" (bound %.6g)", *check.bound);
  }
  if (check.status == CheckStatus::kFailed && !is_count) line += format(", %zu violations", check.violations);
  if (check.status == CheckStatus::kFailed && check.where) {
    line += format(", at %.6g %.6g %.6g", check.where->x, check.where->y, check.where->z);
  }
  if (!check.note.empty()) line += "  [" + check.note + "]";
  return line + "\n";
}

// A row of bars, one character per bin: as wide as the distribution's range, as high as its share of the fullest bin.
std::string bars(const Distribution& d) {
  static const char* kLevels[] = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const std::size_t fullest = d.bins.empty() ? 0 : *std::max_element(d.bins.begin(), d.bins.end());
  std::string row;
  for (std::size_t bin : d.bins) {
    row += kLevels[bin == 0 ? 0 : 1 + 7 * bin / std::max<std::size_t>(1, fullest)];
  }
  return row;
}

std::string line_of(const char* name, const Distribution& d) {
  if (d.count == 0) return {};
  return format("%-12s %10.4g .. %-10.4g mean %-9.4g ", name, d.min, d.max, d.mean) + bars(d) +
         format("  (%g to %g)\n", d.low, d.high);
}

std::string text_of(const MeshStatistics& s) {
  std::string text = format("points %zu, tets %zu, surface triangles %zu\n", s.points, s.tets, s.triangles);
  text += format("surface components %zu (%zu cavities), Euler number %ld", s.surface_components, s.cavities, s.euler);
  if (s.components.size() == 1) text += format(", genus %ld", s.components[0].genus);
  text += s.tets > 0 ? format(", tet components %zu\n", s.tet_components) : "\n";
  text += format("volume %.9g mm3, surface area %.9g mm2\n", s.volume_mm3, s.area_mm2);
  text += line_of("angle/deg", s.angle_degrees) + line_of("dihedral/deg", s.dihedral_degrees) +
          line_of("radius-edge", s.radius_edge) + line_of("edge/mm", s.edge_mm) +
          line_of("face angle", s.face_angle_degrees) + line_of("aspect", s.aspect_ratio) +
          line_of("shape factor", s.shape_factor) + line_of("Jacobian", s.jacobian_ratio);
  return text;
}

std::string text_of(const std::vector<SolverLimit>& limits) {
  std::string text;
  for (const SolverLimit& limit : limits) {
    if (limit.count == 0) continue;
    text += format("  %s %s: %s %s %.6g for %zu tets, worst %.6g at %.6g %.6g %.6g\n", limit.solver.c_str(),
                   limit.severity.c_str(), limit.measure.c_str(), limit.at_least ? "below" : "above", limit.limit,
                   limit.count, limit.worst, limit.where.x, limit.where.y, limit.where.z);
  }
  return text.empty() ? "what solvers limit (Abaqus, ANSYS): within all limits\n" : "what solvers object to:\n" + text;
}

std::string text_of(const SurfaceDistances& d, const char* surface) {
  return format("mesh to %s: max %.4g mm, mean %.4g mm; %s to mesh: max %.4g mm, mean %.4g mm\n", surface,
                d.mesh_to_surface_max_mm, d.mesh_to_surface_mean_mm, surface, d.surface_to_mesh_max_mm,
                d.surface_to_mesh_mean_mm);
}

std::string text_of(const FeatureComparison& c) {
  std::string text;
  if (c.sharp_edges > 0) {
    text += format("sharp edges (normals more than %g deg apart): %zu of the surface, %.6g mm, followed by %zu edges to "
                   "within %.3g mm",
                   c.angle_degrees, c.sharp_edges, c.length_mm, c.kept_edges, c.distance_mm);
    text += c.missing_mm > 0 ? format("; %.6g mm missing\n", c.missing_mm) : "\n";
  }
  text += format("at sharp edges, where bounds on shapes do not hold: %zu triangles, %zu of them below the angle", c.triangles,
                 c.below_min_angle);
  if (c.tets > 0) {
    text += format("; %zu tets, %zu above the radius-edge ratio, %zu below the dihedral angle", c.tets, c.above_radius_edge,
                   c.below_min_dihedral);
  }
  return text + "\n";
}

std::string text_of(const VoxelComparison& c) {
  std::string text = format("voxels: surface components %zu, inside components %zu, cavities %zu, Euler number %ld\n",
                            c.voxels.surface_components, c.voxels.inside_components, c.voxels.cavities, c.voxels.euler);
  text += format("volume of the voxels %.9g mm3, mesh / voxels %.6f\n", c.voxel_volume_mm3, c.volume_ratio);
  return text + text_of(c.distances, "isosurface");
}

}  // namespace

std::string to_text(const CheckReport& report) {
  std::size_t width = 0;
  for (const Check& check : report.checks) width = std::max(width, check.name.size());
  std::string text;
  for (const Check& check : report.checks) text += line_of(check, width);
  text += text_of(report.statistics);
  if (!report.solver_limits.empty()) text += text_of(report.solver_limits);
  if (report.comparison) text += text_of(*report.comparison);
  if (report.feature_comparison) text += text_of(*report.feature_comparison);
  if (report.surface_comparison) text += text_of(report.surface_comparison->distances, "surface");
  return text + (report.all_hold() ? "every check holds\n" : "NOT every check holds\n");
}

}  // namespace delvox
