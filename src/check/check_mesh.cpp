#include "delvox/check/check_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "check/crossing_triangles.h"
#include "check/element_quality.h"
#include "check/feature_checks.h"
#include "check/function_checks.h"
#include "check/gradation.h"
#include "check/point_checks.h"
#include "check/report_builder.h"
#include "check/roughness.h"
#include "check/second_order_checks.h"
#include "check/solver_limits.h"
#include "check/surface_checks.h"
#include "check/surface_topology.h"
#include "check/tet_topology.h"
#include "check/voxel_checks.h"
#include "core/parallel.h"

namespace delvox {
namespace {

using check::Precision;
using check::ReportBuilder;
using check::Tally;

constexpr std::size_t kChunk = std::size_t{1} << 16;  // cells or points looked at together

template <class Cell>
Tally invalid_indices(const std::vector<Cell>& cells, std::size_t point_count) {
  return sum_of(map_chunks(cells.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    Tally faults;
    for (std::size_t i = begin; i < end; ++i) {
      if (*std::max_element(cells[i].begin(), cells[i].end()) >= point_count) faults.add({});
    }
    return faults;
  }));
}

template <class Cell>
void mark_used(const std::vector<Cell>& cells, std::vector<std::uint8_t>& used) {
  for_each_chunk(cells.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // Several threads may say the same of one point.
      for (std::uint32_t v : cells[i]) std::atomic_ref<std::uint8_t>(used[v]).store(1, std::memory_order_relaxed);
    }
  });
}

Tally orphan_points(const std::vector<Point3>& points, const std::vector<std::uint8_t>& used) {
  Tally orphans;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (used[i] == 0) orphans.add(points[i]);
  }
  return orphans;
}

class MeshChecker {
 public:
  MeshChecker(const Mesh& mesh, const CheckOptions& options)
      : tets_(std::get_if<TetMesh>(&mesh)),
        surface_(std::get_if<SurfaceMesh>(&mesh)),
        points_(tets_ ? tets_->points : surface_->points),
        info_(tets_ ? tets_->info : surface_->info),
        options_(options),
        bounds_(options.bounds.value_or(info_.promises)),
        feature_angle_(options.feature_angle_degrees ? options.feature_angle_degrees : bounds_.feature_angle_degrees),
        builder_(report_) {}

  CheckReport run() {
    builder_.fault_of_all("complete run", !info_.complete, "the mesh says that its run was stopped or missed a bound");
    if (!check_arrays()) return std::move(report_);
    precision_ = coordinate_precision();
    check_points();
    if (tets_ != nullptr) check_tets();
    triangles_ = tets_ != nullptr ? std::span<const Triangle>(tet_topology_.boundary) : surface_->triangles;
    check_surface_topology();
    check_features();
    check_bounds();
    if (options_.level == CheckLevel::kFull) {
      builder_.count("no crossing triangles", check::crossing_triangles(points_, triangles_));
      check_voxels();
      if (tets_ != nullptr) measure_for_solvers();
      if (options_.surface != nullptr) check::check_against_surface(surface_of_mesh(), options_, builder_, report_);
      if (options_.function != nullptr) check::check_against_function(surface_of_mesh(), options_, builder_, report_);
    }
    return std::move(report_);
  }

 private:
  bool check_arrays() {
    Tally not_finite, nothing;
    for (const Point3& p : points_) {
      if (!is_finite(p)) not_finite.add({});
    }
    const std::size_t cells = tets_ != nullptr ? tets_->tets.size() : surface_->triangles.size();
    if (cells == 0) nothing.add({});
    Tally invalid = tets_ != nullptr ? invalid_indices(tets_->tets, points_.size())
                                     : invalid_indices(surface_->triangles, points_.size());
    if (tets_ != nullptr) {
      invalid.count += invalid_indices(tets_->boundary, points_.size()).count;
      invalid.count += invalid_indices(tets_->mid_nodes, points_.size()).count;
      if (!tets_->mid_nodes.empty() && tets_->mid_nodes.size() != tets_->tets.size()) invalid.add({});
      if (!tets_->regions.empty() && tets_->regions.size() != tets_->tets.size()) invalid.add({});
    }
    builder_.count("not empty", nothing);
    builder_.count("finite coordinates", not_finite);
    builder_.count("valid indices", invalid);
    return not_finite.count + invalid.count + nothing.count == 0;
  }

  Precision coordinate_precision() const {
    double largest = 0;
    for (const Point3& p : points_) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return {std::sqrt(3.0) * options_.coordinate_error * largest};
  }

  void check_points() {
    builder_.count("no duplicate points", check::duplicate_points(points_, 0));
    if (precision_.displacement_mm > 0) {
      builder_.count("points apart at the format's precision",
                     check::duplicate_points(points_, precision_.displacement_mm));
    }
    std::vector<std::uint8_t> used(points_.size(), 0);
    if (tets_ != nullptr) {
      mark_used(tets_->tets, used);
      mark_used(tets_->mid_nodes, used);
    } else {
      mark_used(surface_->triangles, used);
    }
    builder_.count("no orphan points", orphan_points(points_, used));
    report_.statistics.points = points_.size();
  }

  void check_tets() {
    quality_ = check::measure_tets(points_, tets_->tets, bounds_, precision_);
    builder_.count("positive tets", quality_.not_positive);
    tet_topology_ = check::tet_topology(*tets_);
    builder_.count("no duplicate tets", tet_topology_.duplicate_tets);
    builder_.count("faces in one or two tets", tet_topology_.crowded_faces);
    builder_.count("tets on both sides of a face", tet_topology_.folded_faces);
    if (tets_->boundary.empty()) {
      builder_.not_applicable("boundary list", "the mesh lists no boundary triangles");
    } else {
      builder_.count("boundary list", check::boundary_list_faults(*tets_, tet_topology_));
    }
    if (!tets_->mid_nodes.empty()) check_second_order();
    report_.statistics.tets = tets_->tets.size();
    report_.statistics.tet_components = tet_topology_.components;
  }

  void measure_for_solvers() {
    check::SolverMeasures measures = check::measure_for_solvers(*tets_);
    report_.solver_limits = std::move(measures.limits);
    MeshStatistics& statistics = report_.statistics;
    statistics.face_angle_degrees = std::move(measures.face_angles);
    statistics.aspect_ratio = std::move(measures.aspect_ratios);
    statistics.shape_factor = std::move(measures.shape_factors);
    statistics.jacobian_ratio = std::move(measures.jacobian_ratios);
  }

  void check_second_order() {
    check::SecondOrderQuality quality = check::measure_second_order(*tets_);
    builder_.count("one mid-side node for each edge", quality.not_shared);
    builder_.bounded("Jacobian", quality.jacobian, 0.0, "of the greatest in the tet",
                     "at nodes, Gauss points and centroid");
    curved_nodes_ = std::move(quality.on_boundary);
    if (tets_->on_surface.size() != points_.size()) return;
    std::erase_if(curved_nodes_, [&](std::uint32_t v) { return tets_->on_surface[v] == 0; });
  }

  void check_surface_topology() {
    topology_ = check::surface_topology(points_, triangles_);
    Tally rim;
    for (const auto& edge : topology_.rim) rim.add(midpoint(points_[edge[0]], points_[edge[1]]));
    if (options_.open_border.value_or(info_.open_border)) {
      builder_.not_applicable("closed surface", std::to_string(rim.count) + " rim edges, an open border is expected");
    } else {
      builder_.count("closed surface", rim, rim.count > 0 ? "edges of one triangle only" : "");
    }
    builder_.count("manifold edges", topology_.crowded_edges);
    builder_.count("manifold vertices", topology_.crowded_vertices);
    builder_.count("consistent orientation", topology_.misoriented_edges);
    builder_.count("no duplicate triangles", topology_.duplicate_triangles);
    if (topology_.closed_manifold()) {
      builder_.count("outward orientation", check::wrongly_oriented_components(points_, triangles_, topology_));
    } else {
      builder_.not_applicable("outward orientation", "only a closed, consistently oriented surface has an outside");
    }
    MeshStatistics& statistics = report_.statistics;
    statistics.triangles = triangles_.size();
    statistics.surface_components = topology_.components.size();
    statistics.euler = topology_.euler;
    statistics.components = topology_.components;
    for (const ComponentStatistics& component : topology_.components) {
      statistics.area_mm2 += component.area_mm2;
      statistics.volume_mm3 += component.volume_mm3;
      if (component.volume_mm3 < 0) ++statistics.cavities;
    }
  }

  /// Where sharp edges are, and whether the mesh keeps them: what touches them is not held to bounds on shapes.
  void check_features() {
    if (!feature_angle_) return;
    const std::vector<Edge>& named = tets_ != nullptr ? tets_->features : surface_->features;
    if (options_.surface != nullptr) {
      features_ = check::find_features(points_, triangles_, *options_.surface, *feature_angle_, precision_);
      check::Extreme missing{features_->missing_mm, features_->missing.count > 0, features_->missing.where,
                             features_->missing.count};
      builder_.bounded("sharp edges kept", missing, 0.0, "mm missing");
    } else if (!named.empty()) {
      features_ = check::named_features(points_.size(), named);
      builder_.not_applicable("sharp edges kept", "those of which surface? Those that the mesh names are taken");
    } else {
      builder_.not_applicable("sharp edges kept", "the surface that they are those of is needed to find them: without it "
                                                  "bounds on shapes, which hold away from them, are not looked at");
      bounds_.min_angle_degrees = bounds_.radius_edge = bounds_.min_dihedral_degrees = std::nullopt;
      bounds_.max_roughness_degrees = std::nullopt;
      if (tets_ != nullptr) quality_ = check::measure_tets(points_, tets_->tets, bounds_, precision_);
      return;
    }
    report_.feature_comparison = FeatureComparison{*feature_angle_,         features_->sharp_edges, features_->length_mm,
                                                   features_->missing_mm, features_->distance_mm, features_->edges.size()};
  }

  /// Those that touch sharp edges, or those that do not.
  template <class Cell>
  std::vector<Cell> at_features(std::span<const Cell> cells, bool touching) const {
    std::vector<Cell> result;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(result), [&](const Cell& cell) {
      return touching == std::any_of(cell.begin(), cell.end(), [&](std::uint32_t v) { return features_->touched[v] != 0; });
    });
    return result;
  }

  void check_triangles_at_features(check::TriangleQuality& triangles) {
    const auto away = at_features(triangles_, false), there = at_features(triangles_, true);
    triangles.angle = check::measure_triangles(points_, away, bounds_, precision_).angle;
    const check::Extreme angle = check::measure_triangles(points_, there, bounds_, precision_).angle;
    builder_.bounded("angle at sharp edges", angle, std::nullopt, "deg",
                     note_at_features(there.size(), "triangles", angle.violations));
    report_.feature_comparison->triangles = there.size();
    report_.feature_comparison->below_min_angle = angle.violations;
  }

  void check_tets_at_features() {
    const std::span<const Tet> tets = tets_->tets;
    const auto there = at_features(tets, true);
    const check::TetQuality away = check::measure_tets(points_, at_features(tets, false), bounds_, precision_);
    const check::TetQuality own = check::measure_tets(points_, there, bounds_, precision_);
    quality_.radius_edge = away.radius_edge;
    quality_.dihedral = away.dihedral;
    builder_.bounded("radius-edge at sharp edges", own.radius_edge, std::nullopt, "",
                     note_at_features(there.size(), "tets", own.radius_edge.violations));
    builder_.bounded("dihedral at sharp edges", own.dihedral, std::nullopt, "deg",
                     note_at_features(there.size(), "tets", own.dihedral.violations));
    FeatureComparison& comparison = *report_.feature_comparison;
    comparison.tets = there.size();
    comparison.above_radius_edge = own.radius_edge.violations;
    comparison.below_min_dihedral = own.dihedral.violations;
  }

  static std::string note_at_features(std::size_t count, const std::string& what, std::size_t beyond) {
    return "of " + std::to_string(count) + " " + what + ", " + std::to_string(beyond) +
           " beyond the bound, which does not hold there";
  }

  void check_bounds() {
    check::TriangleQuality triangles = check::measure_triangles(points_, triangles_, bounds_, precision_);
    builder_.count("no degenerate triangles", triangles.degenerate);
    if (features_) check_triangles_at_features(triangles);
    builder_.bounded("angle", triangles.angle, bounds_.min_angle_degrees, "deg");
    builder_.bounded("size", triangles.circumradius, bounds_.size, "mm",
                     "circumradius, the least radius that the surface ball can have");
    const std::vector<Edge> kept = features_ ? features_->edges : std::vector<Edge>();
    builder_.bounded("roughness", check::measure_roughness(points_, triangles_, bounds_, precision_, kept),
                     bounds_.max_roughness_degrees, "deg");
    report_.statistics.angle_degrees = triangles.angles;
    report_.statistics.edge_mm = triangles.edges;
    if (bounds_.max_deviation) builder_.not_applicable("deviation", "needs the volume");
    if (tets_ == nullptr) return;
    if (features_) check_tets_at_features();
    builder_.bounded("radius-edge", quality_.radius_edge, bounds_.radius_edge, "");
    builder_.bounded("cell size", quality_.circumradius, bounds_.cell_size, "mm");
    check_gradation();
    builder_.bounded("dihedral", quality_.dihedral, bounds_.min_dihedral_degrees, "deg");
    report_.statistics.volume_mm3 = quality_.volume_mm3;
    report_.statistics.dihedral_degrees = quality_.dihedrals;
    report_.statistics.radius_edge = quality_.ratios;
    report_.statistics.edge_mm = quality_.edges;
  }

  void check_gradation() {
    if (!bounds_.grade || !bounds_.size || !(*bounds_.grade > 0)) return;
    const check::GradedBound bound{*bounds_.size, *bounds_.grade};
    builder_.bounded("graded cell size",
                     check::measure_gradation(points_, tets_->tets, triangles_, bound, precision_), 1.0,
                     "of the bound", "at the circumcentre: size + grade * (distance to boundary nodes + size / 2)");
  }

  void check_voxels() {
    if (options_.volume == nullptr) return;
    if (!options_.isosurface && !info_.isovalue) {
      builder_.not_applicable("nodes on the isosurface", "a volume, but no isovalue: neither given nor in the mesh");
      return;
    }
    const Isosurface surface = options_.isosurface.value_or(Isosurface{info_.isovalue.value_or(0), info_.below});
    check::check_against_voxels(surface_of_mesh(), surface, options_, builder_, report_);
  }

  check::SurfaceOfMesh surface_of_mesh() const {
    return {points_,
            triangles_,
            topology_,
            report_.statistics.volume_mm3,
            bounds_,
            precision_,
            options_.open_border.value_or(info_.open_border),
            info_.isovalue.has_value(),
            curved_nodes_};
  }

  const TetMesh* tets_;
  const SurfaceMesh* surface_;
  const std::vector<Point3>& points_;
  const MeshInfo& info_;
  const CheckOptions& options_;
  Promises bounds_;
  const std::optional<double> feature_angle_;
  std::optional<check::KeptFeatures> features_;
  CheckReport report_;
  ReportBuilder builder_;
  Precision precision_;
  check::TetQuality quality_;
  check::TetTopology tet_topology_;
  std::vector<std::uint32_t> curved_nodes_;  ///< mid-side nodes that the mesh says are on the surface, or may be
  check::SurfaceTopology topology_;
  std::span<const Triangle> triangles_;
};

}  // namespace

const char* to_string(CheckStatus status) {
  switch (status) {
    case CheckStatus::kPassed: return "passed";
    case CheckStatus::kFailed: return "failed";
    case CheckStatus::kNotApplicable: return "not applicable";
  }
  return "";
}

bool CheckReport::all_hold() const {
  return std::none_of(checks.begin(), checks.end(), [](const Check& c) { return c.status == CheckStatus::kFailed; });
}

const Check* CheckReport::find(const std::string& name) const {
  const auto found = std::find_if(checks.begin(), checks.end(), [&](const Check& c) { return c.name == name; });
  return found == checks.end() ? nullptr : &*found;
}

CheckReport check_mesh(const Mesh& mesh, const CheckOptions& options) {
  return MeshChecker(mesh, options).run();
}

}  // namespace delvox
