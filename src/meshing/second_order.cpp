#include "delvox/meshing/second_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/flat_hash.h"
#include "delvox/core/errors.h"

namespace delvox {
namespace {

constexpr double kReach = 0.3;           // edge lengths
constexpr double kLeastJacobian = 0.02;  // of the straight tet's

/// Barycentric coordinates of the four Gauss points of second degree.
constexpr double kGaussNear = 0.58541019662496852, kGaussFar = 0.1381966011250105;

using Barycentric = std::array<double, 4>;

std::vector<Barycentric> tested_points() {
  std::vector<Barycentric> points;
  for (std::size_t i = 0; i < 4; ++i) {
    Barycentric corner{}, gauss;
    corner[i] = 1;
    gauss.fill(kGaussFar);
    gauss[i] = kGaussNear;
    points.push_back(corner);
    points.push_back(gauss);
  }
  for (const auto& edge : kTetEdges) {
    Barycentric middle{};
    middle[static_cast<std::size_t>(edge[0])] = middle[static_cast<std::size_t>(edge[1])] = 0.5;
    points.push_back(middle);
  }
  return points;
}

class Builder {
 public:
  Builder(TetMesh& mesh, const Oracle* oracle) : mesh_(mesh), oracle_(oracle), corner_count_(mesh.points.size()) {}

  SecondOrderReport run() {
    add_middles();
    if (oracle_ != nullptr) {
      collect_boundary();
      for (const Edge& e : mesh_.features) features_.push_back({std::min(e[0], e[1]), std::max(e[0], e[1])});
      std::sort(features_.begin(), features_.end());
      for (std::size_t i = 0; i < edges_.size(); ++i) curve(edges_[i]);
      straighten_where_needed();
    }
    mark_on_surface();
    return report_;
  }

 private:
  struct BoundaryEdge {
    std::uint32_t middle, a, b;
    Vector3 normal;  ///< sum of those of its triangles
    bool curved = false;
  };
  struct Use {
    std::uint32_t middle, tet;
  };

  void add_middles();
  void collect_boundary();
  void curve(BoundaryEdge& edge);
  double least_jacobian_ratio(std::uint32_t tet) const;
  void straighten_where_needed();
  std::uint32_t most_curved(std::uint32_t tet);
  void straighten(std::uint32_t middle);
  void mark_on_surface();

  BoundaryEdge* boundary_edge(std::uint32_t middle) {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), middle,
                                        [](const BoundaryEdge& e, std::uint32_t m) { return e.middle < m; });
    return found == edges_.end() || found->middle != middle ? nullptr : &*found;
  }
  bool is_curved(std::uint32_t middle) {
    const BoundaryEdge* edge = boundary_edge(middle);
    return edge != nullptr && edge->curved;
  }

  TetMesh& mesh_;
  const Oracle* oracle_;
  const std::size_t corner_count_;
  std::vector<BoundaryEdge> edges_;  ///< of the boundary, by middle
  std::vector<Edge> features_;       ///< the lower number first, in order
  SecondOrderReport report_;
  const std::vector<Barycentric> tested_ = tested_points();
};

// Numbers the middles in the order in which the tets name them.
void Builder::add_middles() {
  FlatHash middle_of;
  mesh_.mid_nodes.reserve(mesh_.tets.size());
  for (const Tet& tet : mesh_.tets) {
    MidNodes& middles = mesh_.mid_nodes.emplace_back();
    for (std::size_t e = 0; e < 6; ++e) {
      const std::uint32_t a = tet[static_cast<std::size_t>(kTetEdges[e][0])];
      const std::uint32_t b = tet[static_cast<std::size_t>(kTetEdges[e][1])];
      std::uint32_t& middle = middle_of[std::uint64_t{std::max(a, b)} << 32 | std::min(a, b)];
      if (middle == FlatHash::kAbsent) {
        if (mesh_.points.size() >= FlatHash::kAbsent) {
          throw OptionError("second order: more nodes than 32 bits can number; give a larger --size");
        }
        middle = static_cast<std::uint32_t>(mesh_.points.size());
        mesh_.points.push_back(midpoint(mesh_.points[std::min(a, b)], mesh_.points[std::max(a, b)]));
      }
      middles[e] = middle;
    }
  }
}

void Builder::collect_boundary() {
  for (TetFace face : boundary_faces(mesh_.tets)) {
    const Triangle v = face_corners(mesh_.tets, face);
    const auto middles = face_mid_nodes(mesh_.mid_nodes[face.tet], face.face);
    const Vector3 normal = cross(mesh_.points[v[1]] - mesh_.points[v[0]], mesh_.points[v[2]] - mesh_.points[v[0]]);
    const Vector3 unit = (1 / norm(normal)) * normal;
    for (std::size_t i = 0; i < 3; ++i) {
      edges_.push_back({middles[i], std::min(v[i], v[(i + 1) % 3]), std::max(v[i], v[(i + 1) % 3]), unit});
    }
  }
  std::stable_sort(edges_.begin(), edges_.end(),
                   [](const BoundaryEdge& x, const BoundaryEdge& y) { return x.middle < y.middle; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (kept > 0 && edges_[kept - 1].middle == edges_[i].middle) {
      edges_[kept - 1].normal = edges_[kept - 1].normal + edges_[i].normal;
    } else {
      edges_[kept++] = edges_[i];
    }
  }
  edges_.resize(kept);
  report_.boundary_edges = kept;
}

// The crossing of the line through the middle, along the normal, that is nearest to it.
void Builder::curve(BoundaryEdge& edge) {
  if (std::binary_search(features_.begin(), features_.end(), Edge{edge.a, edge.b})) {
    edge.curved = true;  // sharp edges are straight: the middle lies on the surface
    return;
  }
  const Point3 middle = mesh_.points[edge.middle];
  const double reach = kReach * distance(mesh_.points[edge.a], mesh_.points[edge.b]);
  const double length = norm(edge.normal);
  if (length > 0) {
    const Vector3 step = (reach / length) * edge.normal;
    double best = std::numeric_limits<double>::infinity();
    for (const Point3& p : oracle_->intersect_all(middle - step, middle + step)) {
      if (squared_distance(p, middle) >= best) continue;
      best = squared_distance(p, middle);
      mesh_.points[edge.middle] = p;
      edge.curved = true;
    }
  }
  if (edge.curved) return;
  ++report_.not_found;
  report_.where_not_found = middle;
}

// With x = sum L_i p_i + sum over edges of 4 L_a L_b d_e, d_e how far the mid-side node is off the middle, the columns
// of the Jacobian matrix are dx/dL_i - dx/dL_0.
double Builder::least_jacobian_ratio(std::uint32_t tet) const {
  const Tet& v = mesh_.tets[tet];
  std::array<Vector3, 6> off;
  for (std::size_t e = 0; e < 6; ++e) {
    const std::uint32_t a = v[static_cast<std::size_t>(kTetEdges[e][0])],
                        b = v[static_cast<std::size_t>(kTetEdges[e][1])];
    off[e] = mesh_.points[mesh_.mid_nodes[tet][e]] - midpoint(mesh_.points[a], mesh_.points[b]);
  }
  const auto determinant = [](const std::array<Vector3, 4>& d) {
    return dot(cross(d[1] - d[0], d[2] - d[0]), d[3] - d[0]);
  };
  const std::array<Vector3, 4> corners{mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
  const double straight = determinant(corners);
  double least = std::numeric_limits<double>::infinity();
  for (const Barycentric& at : tested_) {
    std::array<Vector3, 4> derivative = corners;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto a = static_cast<std::size_t>(kTetEdges[e][0]), b = static_cast<std::size_t>(kTetEdges[e][1]);
      derivative[a] = derivative[a] + (4 * at[b]) * off[e];
      derivative[b] = derivative[b] + (4 * at[a]) * off[e];
    }
    least = std::min(least, determinant(derivative) / straight);
  }
  return least;
}

void Builder::straighten_where_needed() {
  std::vector<Use> uses;  // of curved middles
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t) {
    bool any = false;
    for (std::uint32_t middle : mesh_.mid_nodes[t]) {
      if (!is_curved(middle)) continue;
      uses.push_back({middle, t});
      any = true;
    }
    if (any) waiting.push_back(t);
  }
  const auto by_middle = [](const Use& x, const Use& y) { return x.middle < y.middle; };
  std::stable_sort(uses.begin(), uses.end(), by_middle);
  for (std::size_t next = 0; next < waiting.size(); ++next) {
    const std::uint32_t tet = waiting[next];
    const auto& middles = mesh_.mid_nodes[tet];
    const bool any_curved = std::any_of(middles.begin(), middles.end(), [&](std::uint32_t m) { return is_curved(m); });
    if (!any_curved || least_jacobian_ratio(tet) >= kLeastJacobian) continue;
    const std::uint32_t middle = most_curved(tet);
    straighten(middle);
    const auto [first, last] = std::equal_range(uses.begin(), uses.end(), Use{middle, 0}, by_middle);
    for (auto use = first; use != last; ++use) waiting.push_back(use->tet);
  }
}

// That of its curved edges whose middle is furthest off the straight one. pre: it has one.
std::uint32_t Builder::most_curved(std::uint32_t tet) {
  std::uint32_t result = mesh_.mid_nodes[tet][0];
  double furthest = -1;
  for (std::uint32_t middle : mesh_.mid_nodes[tet]) {
    const BoundaryEdge* edge = boundary_edge(middle);
    if (edge == nullptr || !edge->curved) continue;
    const double off = distance(mesh_.points[middle], midpoint(mesh_.points[edge->a], mesh_.points[edge->b]));
    if (off <= furthest) continue;
    furthest = off;
    result = middle;
  }
  return result;
}

void Builder::straighten(std::uint32_t middle) {
  BoundaryEdge& edge = *boundary_edge(middle);
  edge.curved = false;
  mesh_.points[middle] = midpoint(mesh_.points[edge.a], mesh_.points[edge.b]);
  ++report_.straightened;
  report_.where_straightened = mesh_.points[middle];
}

void Builder::mark_on_surface() {
  report_.on_surface = report_.boundary_edges - report_.not_found - report_.straightened;
  if (mesh_.on_surface.size() != corner_count_) return;
  mesh_.on_surface.resize(mesh_.points.size(), 0);
  for (const BoundaryEdge& edge : edges_) mesh_.on_surface[edge.middle] = edge.curved ? 1 : 0;
}

}  // namespace

SecondOrderReport make_second_order(TetMesh& mesh, const Oracle* oracle) {
  return Builder(mesh, oracle).run();
}

void make_first_order(TetMesh& mesh) {
  std::vector<std::uint8_t> goes(mesh.points.size(), 0);
  for (const MidNodes& middles : mesh.mid_nodes) {
    for (std::uint32_t v : middles) goes[v] = 1;
  }
  for (const Tet& tet : mesh.tets) {
    for (std::uint32_t v : tet) goes[v] = 0;
  }
  std::vector<std::uint32_t> renumbered(mesh.points.size());
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < goes.size(); ++i) {
    if (goes[i]) continue;
    mesh.points[kept] = mesh.points[i];
    if (!mesh.on_surface.empty()) mesh.on_surface[kept] = mesh.on_surface[i];
    renumbered[i] = kept++;
  }
  mesh.points.resize(kept);
  if (!mesh.on_surface.empty()) mesh.on_surface.resize(kept);
  for (Tet& tet : mesh.tets) {
    for (std::uint32_t& v : tet) v = renumbered[v];
  }
  for (Triangle& triangle : mesh.boundary) {
    for (std::uint32_t& v : triangle) v = renumbered[v];
  }
  for (MeshSet& set : mesh.sets) {
    std::erase_if(set.nodes, [&](std::uint32_t v) { return goes[v] != 0; });
    for (std::uint32_t& v : set.nodes) v = renumbered[v];
  }
  mesh.mid_nodes.clear();
}

}  // namespace delvox
