// Limits of Abaqus/CAE's mesh verification (Abaqus/CAE User's Guide, "Verifying element quality", defaults for tets)
// and of ANSYS's shape checking (Mechanical APDL Theory Reference, 12.1, defaults for tets; faces only, no
// cross-sections). The measures were compared with 12.1.2 there and with Altair's account of both programs' checks
// ("Element quality calculations"); the pages with the numbers of the limits could not be read.
#include "check/solver_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "check/second_order_checks.h"
#include "core/parallel.h"

namespace delvox::check {
namespace {

constexpr std::size_t kChunk = 8192;
constexpr double kDegrees = 180 / std::numbers::pi;

/// What is measured of one tet; of the angles the worst two.
enum Measure : std::size_t {
  kLeastAngle,
  kGreatestAngle,
  kEdgeRatio,
  kStretch,
  kShapeFactor,
  kJacobianRatio,
  kMeasures
};
using Values = std::array<double, kMeasures>;

struct Limit {
  const char* solver;
  const char* measure;
  Measure value;
  bool at_least;  ///< the limit is a least value
  double limit;
  const char* severity;
};
constexpr Limit kLimits[] = {
    {"Abaqus", "face corner angle, deg", kLeastAngle, true, 5, "warning"},
    {"Abaqus", "face corner angle, deg", kGreatestAngle, false, 170, "warning"},
    {"Abaqus", "longest / shortest edge", kEdgeRatio, false, 10, "warning"},
    {"Abaqus", "shape factor", kShapeFactor, true, 0.01, "warning"},
    {"ANSYS", "face corner angle, deg", kGreatestAngle, false, 165, "warning"},
    {"ANSYS", "face corner angle, deg", kGreatestAngle, false, 179.9, "error"},
    {"ANSYS", "aspect ratio of faces", kStretch, false, 20, "warning"},
    {"ANSYS", "aspect ratio of faces", kStretch, false, 1e6, "error"},
    {"ANSYS", "Jacobian ratio", kJacobianRatio, false, 30, "warning"},
    {"ANSYS", "Jacobian ratio", kJacobianRatio, false, 1000, "error"},
};

/// ANSYS's aspect ratio of a triangle: the more stretched of two rectangles for each corner, over that of the
/// equilateral one. They lie along the line from the corner to the middle of the opposite edge and along that between
/// the other two middles.
double stretch(const Point3& a, const Point3& b, const Point3& c) {
  const std::array<Point3, 3> p{a, b, c};
  const double twice_area = norm(cross(b - a, c - a));
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 median = midpoint(p[(i + 1) % 3], p[(i + 2) % 3]) - p[i];
    const Vector3 middle_line = 0.5 * (p[(i + 2) % 3] - p[(i + 1) % 3]);
    // Median and middle line span half the triangle's doubled area: the width across one is that over its length.
    for (double length : {norm(median), norm(middle_line)}) {
      const double width = 0.5 * twice_area / length;
      worst = std::max(worst, std::max(length / width, width / length));
    }
  }
  return worst / std::numbers::sqrt3;
}

Values measure(const std::array<Point3, 4>& p) {
  Values values{180, 0, 0, 0, 0, 1};
  double shortest2 = std::numeric_limits<double>::infinity(), longest2 = 0;
  for (const auto& edge : kTetEdges) {
    const double length2 = squared_distance(p[static_cast<std::size_t>(edge[0])], p[static_cast<std::size_t>(edge[1])]);
    shortest2 = std::min(shortest2, length2);
    longest2 = std::max(longest2, length2);
  }
  values[kEdgeRatio] = std::sqrt(longest2 / shortest2);
  for (const auto& face : kTetFaces) {
    const Point3 q[3] = {p[static_cast<std::size_t>(face[0])], p[static_cast<std::size_t>(face[1])],
                         p[static_cast<std::size_t>(face[2])]};
    for (int i = 0; i < 3; ++i) {
      const Vector3 u = q[(i + 1) % 3] - q[i], v = q[(i + 2) % 3] - q[i];
      const double angle = std::atan2(norm(cross(u, v)), dot(u, v)) * kDegrees;
      values[kLeastAngle] = std::min(values[kLeastAngle], angle);
      values[kGreatestAngle] = std::max(values[kGreatestAngle], angle);
    }
    values[kStretch] = std::max(values[kStretch], stretch(q[0], q[1], q[2]));
  }
  // Volume over that of the regular tet with the same circumsphere, 8 sqrt(3) / 27 R^3.
  const Vector3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double six = dot(a, bc);
  const double radius = norm(squared_norm(a) * bc + squared_norm(b) * ca + squared_norm(c) * ab) / (2 * std::abs(six));
  values[kShapeFactor] = six == 0 ? 0 : six / 6 / (8 * std::numbers::sqrt3 / 27 * radius * radius * radius);
  return values;
}

/// Equal bins of [low, high], as in Distribution.
void add(Distribution& d, double value) {
  d.min = d.count == 0 ? value : std::min(d.min, value);
  d.max = d.count == 0 ? value : std::max(d.max, value);
  d.mean += value;  // a sum until finish()
  ++d.count;
  const double bin = (value - d.low) / (d.high - d.low) * static_cast<double>(d.bins.size());
  ++d.bins[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(d.bins.size()) - 1))];
}

void append(Distribution& d, const Distribution& later) {
  if (later.count == 0) return;
  d.min = d.count == 0 ? later.min : std::min(d.min, later.min);
  d.max = d.count == 0 ? later.max : std::max(d.max, later.max);
  d.mean += later.mean;
  d.count += later.count;
  for (std::size_t i = 0; i < d.bins.size(); ++i) d.bins[i] += later.bins[i];
}

void finish(Distribution& d) {
  if (d.count > 0) d.mean /= static_cast<double>(d.count);
}

Distribution empty(double low, double high, std::size_t bins) {
  Distribution d;
  d.low = low;
  d.high = high;
  d.bins.assign(bins, 0);
  return d;
}

SolverMeasures nothing_yet() {
  SolverMeasures m{empty(0, 180, 36), empty(1, 11, 40), empty(0, 1, 40), empty(1, 31, 40), {}};
  for (const Limit& limit : kLimits) {
    m.limits.push_back({limit.solver, limit.measure, limit.severity, limit.at_least, limit.limit, 0, 0, {}});
  }
  return m;
}

void take(const Values& values, const Point3& where, bool second_order, bool first, SolverMeasures& m) {
  add(m.face_angles, values[kLeastAngle]);
  add(m.face_angles, values[kGreatestAngle]);
  add(m.aspect_ratios, values[kStretch]);
  add(m.shape_factors, values[kShapeFactor]);
  if (second_order) add(m.jacobian_ratios, values[kJacobianRatio]);
  for (std::size_t i = 0; i < std::size(kLimits); ++i) {
    SolverLimit& limit = m.limits[i];
    const double value = values[kLimits[i].value];
    const bool kept = limit.at_least ? value >= limit.limit : value <= limit.limit;
    if (!kept) ++limit.count;
    if (first || (limit.at_least ? value < limit.worst : value > limit.worst)) {
      limit.worst = value;
      limit.where = where;
    }
  }
}

}  // namespace

SolverMeasures measure_for_solvers(const TetMesh& mesh) {
  const bool second_order = mesh.mid_nodes.size() == mesh.tets.size() && !mesh.tets.empty();
  const std::vector<double> jacobians = second_order ? jacobian_ratios(mesh) : std::vector<double>();
  const auto parts = map_chunks(mesh.tets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    SolverMeasures part = nothing_yet();
    for (std::size_t t = begin; t < end; ++t) {
      std::array<Point3, 4> p;
      for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.points[mesh.tets[t][i]];
      Values values = measure(p);
      // From least over greatest to greatest over least; negative where the tet is inside out, and worse than any
      // limit.
      if (second_order)
        values[kJacobianRatio] = jacobians[t] > 0 ? 1 / jacobians[t] : std::numeric_limits<double>::max();
      take(values, 0.25 * ((p[0] + p[1]) + (p[2] + p[3])), second_order, t == begin, part);
    }
    return part;
  });
  SolverMeasures all = nothing_yet();
  bool first = true;
  for (const SolverMeasures& part : parts) {
    append(all.face_angles, part.face_angles);
    append(all.aspect_ratios, part.aspect_ratios);
    append(all.shape_factors, part.shape_factors);
    append(all.jacobian_ratios, part.jacobian_ratios);
    for (std::size_t i = 0; i < all.limits.size(); ++i) {
      SolverLimit& limit = all.limits[i];
      const SolverLimit& later = part.limits[i];
      limit.count += later.count;
      if (!first && !(limit.at_least ? later.worst < limit.worst : later.worst > limit.worst)) continue;
      limit.worst = later.worst;
      limit.where = later.where;
    }
    first = false;
  }
  for (Distribution* d : {&all.face_angles, &all.aspect_ratios, &all.shape_factors, &all.jacobian_ratios}) finish(*d);
  return all;
}

}  // namespace delvox::check
