#include <algorithm>

#include "delvox/core/errors.h"
#include "meshing/feature_rings.h"
#include "meshing/refinement.h"
#include "oracle/poisson_thinning.h"

namespace delvox {

void Refinement::keep_features(double longest, bool solid) {
  if (!(surface_.feature_angle_degrees < 180)) return;
  if (variant_.start != Start::kSeeds || variant_.restricted != Restricted::kBipolar) {
    throw OptionError("feature-angle: sharp edges are kept with seeds and bipolar Voronoi edges only");
  }
  std::optional<FeatureEdges> edges = oracle_.feature_edges(surface_.feature_angle_degrees);
  if (!edges) throw OptionError("feature-angle: only polygon surfaces have sharp edges to be kept");
  if (edges->edges.empty()) return;
  solid_ = solid;
  // A segment's ball at the floor is as small as a surface ball that is left alone.
  features_.emplace(std::move(*edges), surface_.size, longest, 2 * surface_.min_ball_radius,
                    [this] { return budget_.go_on(0, 0); });
}

/// Nodes of segments become vertices first of all; then what is mirrored beside them; then seeds that are as far from
/// these as from each other. A component without sharp edges keeps at least one seed, though segments of others give
/// way.
void Refinement::insert_seeds_beside_features(const Seeds& seeds, const GoOn& go_on) {
  PoissonThinner thinner(surface_.size.minimum());
  std::vector<Point3> points;
  for (std::uint32_t n = 0; n < features_->node_count(); ++n) {
    points.push_back(features_->node(n));
    thinner.add(points.back(), surface_.size(points.back()));
  }
  for (const Point3& p : mirrored_points(*features_, oracle_, solid_, thinner, go_on)) points.push_back(p);
  std::vector<bool> sharp(seeds.components, false), met(seeds.components, false);
  for (std::uint32_t s = 0; s < features_->segment_count(); ++s) sharp[features_->edge(s).component] = true;
  for (std::size_t i = 0; i < seeds.points.size(); ++i) {
    const Point3& p = seeds.points[i];
    const std::uint32_t component = seeds.component_of[i];
    if (features_->encroached_by(p) || (sharp[component] && !thinner.has_room(p, surface_.size(p)))) continue;
    met[component] = true;
    points.push_back(p);
  }
  vertex_of_node_ = delaunay_.insert_seeds(points, go_on);
  vertex_of_node_.resize(features_->node_count());
  for (std::uint32_t n = 0; n < features_->node_count(); ++n) note_node(n, vertex_of_node_[n]);
  enqueue_created();
  for (std::size_t i = 0; i < seeds.points.size(); ++i) {
    const std::uint32_t component = seeds.component_of[i];
    if (sharp[component] || met[component]) continue;
    met[component] = true;
    insert_surface_point(seeds.points[i], delaunay_.some_cell());
  }
}

void Refinement::note_node(std::uint32_t node, VertexId vertex) {
  if (node >= vertex_of_node_.size()) vertex_of_node_.resize(node + 1, kNone);
  vertex_of_node_[node] = vertex;
  if (vertex == kNone) return;
  if (vertex >= node_of_vertex_.size()) node_of_vertex_.resize(delaunay_.vertex_capacity(), kNone);
  node_of_vertex_[vertex] = node;
}

/// Is the edge that two triangles share a segment?
bool Refinement::kept_edge(FacetId one, FacetId other) const {
  if (!features_) return false;
  std::vector<std::uint32_t> shared;
  const auto of_other = delaunay_.vertices(other);
  for (VertexId v : delaunay_.vertices(one)) {
    if (node_of(v) != kNone && std::find(of_other.begin(), of_other.end(), v) != of_other.end()) shared.push_back(node_of(v));
  }
  return shared.size() == 2 && features_->joined(shared[0], shared[1]);
}

/// What stands in the way of a point that is to be inserted for a cell or triangle: a segment to be split in its place,
/// or the cell is to be left as it is, because it touches a segment and is but ill-shaped, or nothing helps.
Refinement::AtFeature Refinement::at_feature(const Point3& p, bool exempt, std::uint32_t& segment) const {
  if (!features_) return AtFeature::kClear;
  const auto encroached = features_->encroached_by(p);
  if (!encroached) return AtFeature::kClear;
  segment = *encroached;
  return exempt || !features_->may_split(segment) ? AtFeature::kLeave : AtFeature::kSplit;
}

/// Halves a segment, and others that the new vertices encroach on. None if it cannot be.
std::optional<VertexId> Refinement::split_feature(std::uint32_t segment) {
  if (!features_->may_split(segment)) return std::nullopt;
  std::vector<std::uint32_t> fresh;
  const auto halve = [&](std::uint32_t s) {
    const VertexId near = vertex_of_node_[features_->segment(s).ends[0]];
    const std::uint32_t node = features_->split(s);
    const CellId hint = near != kNone ? delaunay_.cell_of(near) : delaunay_.some_cell();
    const auto vertex = insert_on_surface(features_->node(node), hint);
    note_node(node, vertex.value_or(kNone));
    if (vertex) ++report_.surface_insertions;
    fresh.push_back(node);
    return vertex;
  };
  const auto first = halve(segment);
  while (!fresh.empty()) {
    const std::uint32_t node = fresh.back();
    fresh.pop_back();
    while (const auto next = features_->encroached_by(features_->node(node), node)) {
      if (!features_->may_split(*next)) break;
      halve(*next);
    }
  }
  return first;
}

/// Of two restricted triangles at the segment's edge, no more and no fewer; none if it is no edge.
bool Refinement::covered(std::uint32_t segment) const {
  const Edge& ends = features_->segment(segment).ends;
  const VertexId a = vertex_of_node_[ends[0]], b = vertex_of_node_[ends[1]];
  if (a == kNone || b == kNone) return false;
  int count = 0;
  for (CellId cell : delaunay_.incident_cells(a)) {
    const auto& v = delaunay_.vertices(cell);
    if (std::find(v.begin(), v.end(), b) == v.end()) continue;
    for (int i = 0; i < 4; ++i) {
      if (v[i] != a && v[i] != b && delaunay_.label(cell) > delaunay_.label(delaunay_.neighbors(cell)[i])) ++count;
    }
  }
  return count == 2;
}

/// For each segment that is not covered one insertion: the farthest crossing of the Voronoi edges around it with the
/// surface, or if that is near, or encroaches, half the segment. True if anything was inserted.
bool Refinement::repair_features() {
  if (!features_ || features_from_ == delaunay_.next_stamp()) return false;
  bool inserted = false;
  uncovered_.clear();
  const std::uint32_t count = features_->segment_count();
  for (std::uint32_t s = 0; s < count; ++s) {
    if (!budget_left()) return inserted;
    if (covered(s)) continue;
    if (repair_feature(s)) {
      inserted = true;
    } else {
      uncovered_.push_back(s);
    }
  }
  if (!inserted) features_from_ = delaunay_.next_stamp();
  return inserted;
}

bool Refinement::repair_feature(std::uint32_t segment) {
  const Edge& ends = features_->segment(segment).ends;
  const VertexId a = vertex_of_node_[ends[0]], b = vertex_of_node_[ends[1]];
  if (a == kNone || b == kNone) return false;
  SurfaceBall largest;
  CellId hint = kNone;
  const std::vector<CellId> cells = delaunay_.incident_cells(a);
  for (CellId cell : cells) {
    const auto& v = delaunay_.vertices(cell);
    if (std::find(v.begin(), v.end(), b) == v.end()) continue;
    for (int i = 0; i < 4; ++i) {
      if (v[i] == a || v[i] == b || !delaunay_.proper({cell, i})) continue;
      for (const Point3& center : delaunay_.dual_crossings({cell, i}, oracle_)) {
        const double squared_radius = squared_distance(center, delaunay_.point(a));
        if (squared_radius <= largest.squared_radius) continue;
        largest = {center, squared_radius};
        hint = cell;
      }
    }
  }
  const double length = features_->length(segment);
  const bool far = hint != kNone && largest.squared_radius > length * length;
  if (far && !features_->encroached_by(largest.center)) {
    if (!insert_on_surface(largest.center, hint)) return false;
  } else if (!split_feature(segment)) {
    return false;
  }
  ++report_.topology_insertions;
  return true;
}

std::vector<std::array<VertexId, 2>> Refinement::feature_edges() const {
  std::vector<std::array<VertexId, 2>> edges;
  if (!features_) return edges;
  for (std::uint32_t s = 0; s < features_->segment_count(); ++s) {
    const Edge& ends = features_->segment(s).ends;
    const VertexId a = vertex_of_node_[ends[0]], b = vertex_of_node_[ends[1]];
    if (a != kNone && b != kNone && covered(s)) edges.push_back({a, b});
  }
  return edges;
}

}  // namespace delvox
