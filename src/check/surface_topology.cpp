#include "check/surface_topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "check/exact_orientation.h"
#include "check/incidence.h"
#include "core/union_find.h"

namespace delvox::check {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// A directed edge is numbered 3 * triangle + its place; so is the corner that it starts from.
std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

std::uint32_t vertex_at(std::span<const Triangle> triangles, std::uint32_t corner) {
  return triangles[corner / 3][corner % 3];
}

struct Joins {
  UnionFind triangles;  // joined across edges: components
  UnionFind corners;    // joined around a vertex: fans
};

struct Edges {
  std::vector<std::uint32_t> owners;  // one triangle of each edge
  std::vector<std::array<std::uint32_t, 2>> rim;
  Tally crowded, misoriented;
};

void visit_edge(const std::vector<Point3>& points, std::span<const Triangle> triangles, std::span<const Incidence> edge,
                Joins& joins, Edges& edges) {
  const auto corner_of_smaller = [](const Incidence& e) { return e.flipped() ? next_corner(e.item()) : e.item(); };
  const auto corner_of_larger = [](const Incidence& e) { return e.flipped() ? e.item() : next_corner(e.item()); };
  const std::uint32_t a = vertex_at(triangles, edge[0].item());
  const std::uint32_t b = vertex_at(triangles, next_corner(edge[0].item()));
  edges.owners.push_back(edge[0].item() / 3);
  if (edge.size() == 1) edges.rim.push_back({a, b});
  if (edge.size() > 2) edges.crowded.add(midpoint(points[a], points[b]));
  if (edge.size() == 2 && edge[0].flipped() == edge[1].flipped()) {
    edges.misoriented.add(midpoint(points[a], points[b]));
  }
  for (std::size_t i = 1; i < edge.size(); ++i) {
    joins.triangles.join(edge[0].item() / 3, edge[i].item() / 3);
    joins.corners.join(corner_of_smaller(edge[0]), corner_of_smaller(edge[i]));
    joins.corners.join(corner_of_larger(edge[0]), corner_of_larger(edge[i]));
  }
}

// All edges, and in `joins` what they hold together.
Edges find_edges(const std::vector<Point3>& points, std::span<const Triangle> triangles, Joins& joins) {
  const auto parts = map_shared_simplices<Edges, 3>(
      points.size(), triangles, [](const Triangle& t, int i) { return edge_key(t[i], t[i == 2 ? 0 : i + 1]); },
      [&](std::span<const Incidence> edge, Edges& edges) { visit_edge(points, triangles, edge, joins, edges); });
  Edges all;
  for (const Edges& part : parts) {
    all.owners.insert(all.owners.end(), part.owners.begin(), part.owners.end());
    all.rim.insert(all.rim.end(), part.rim.begin(), part.rim.end());
    all.crowded.append(part.crowded);
    all.misoriented.append(part.misoriented);
  }
  return all;
}

void count_vertices(const std::vector<Point3>& points, std::span<const Triangle> triangles, UnionFind& corners,
                    SurfaceTopology& result) {
  std::vector<std::uint32_t> fan(points.size(), kNone);
  std::vector<bool> crowded(points.size(), false);
  for (std::uint32_t corner = 0; corner < 3 * triangles.size(); ++corner) {
    const std::uint32_t vertex = vertex_at(triangles, corner), root = corners.root(corner);
    if (fan[vertex] == kNone) {
      fan[vertex] = root;
      ++result.vertices;
    } else if (fan[vertex] != root && !crowded[vertex]) {
      crowded[vertex] = true;
      result.crowded_vertices.add(points[vertex]);
    }
  }
}

Tally duplicate_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles) {
  return sum_of(map_shared_simplices<Tally, 1>(points.size(), triangles, triangle_key,
                                               [&](std::span<const Incidence> same, Tally& duplicates) {
                                                 for (std::size_t i = 1; i < same.size(); ++i)
                                                   duplicates.add(points[triangles[same[i].item()][0]]);
                                               }));
}

// Fans, not vertices, are counted per component, so a component keeps its own genus where it touches another.
void measure_components(const std::vector<Point3>& points, std::span<const Triangle> triangles, Joins& joins,
                        std::span<const std::uint32_t> edge_owners, SurfaceTopology& result) {
  std::vector<std::uint32_t> number(triangles.size(), kNone);
  Box3 box;
  for (const Triangle& t : triangles) {
    for (std::uint32_t v : t) box.extend(points[v]);
  }
  const Point3 center = box.center();
  result.component_of.resize(triangles.size());
  auto& components = result.components;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    std::uint32_t& index = number[joins.triangles.root(t)];
    if (index == kNone) {
      index = static_cast<std::uint32_t>(components.size());
      components.emplace_back();
    }
    result.component_of[t] = index;
    const Point3 a = points[triangles[t][0]] - center, b = points[triangles[t][1]] - center,
                 c = points[triangles[t][2]] - center;
    ComponentStatistics& component = components[index];
    ++component.triangles;
    ++component.euler;
    component.volume_mm3 += dot(a, cross(b, c)) / 6;
    component.area_mm2 += norm(cross(b - a, c - a)) / 2;
  }
  for (std::uint32_t owner : edge_owners) --components[result.component_of[owner]].euler;
  for (std::uint32_t corner = 0; corner < 3 * triangles.size(); ++corner) {
    if (joins.corners.root(corner) == corner) ++components[result.component_of[corner / 3]].euler;
  }
  for (ComponentStatistics& component : components) component.genus = (2 - component.euler) / 2;
}

void sort_components(SurfaceTopology& result) {
  std::vector<std::uint32_t> order(result.components.size()), rank(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return result.components[a].area_mm2 > result.components[b].area_mm2;
  });
  std::vector<ComponentStatistics> sorted;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = i;
    sorted.push_back(result.components[order[i]]);
  }
  result.components = std::move(sorted);
  for (std::uint32_t& component : result.component_of) component = rank[component];
}

// Rays along +x, one from a point of each component, filed by where they meet the plane of y and z: there are few of
// them, and most triangles' shadows meet none.
class Rays {
 public:
  Rays(const std::vector<Point3>& points, std::span<const Triangle> triangles, const std::vector<std::uint32_t>& starts)
      : points_(points), triangles_(triangles), starts_(starts), odd_(starts.size(), 0) {
    for (std::uint32_t start : starts) box_.extend(points[start]);
    side_ = std::clamp<int>(4 * static_cast<int>(std::sqrt(static_cast<double>(starts.size()))), 1, 1024);
    bins_.resize(static_cast<std::size_t>(side_) * side_);
    for (std::uint32_t ray = 0; ray < starts.size(); ++ray) {
      const Point3& p = points[starts[ray]];
      bins_[static_cast<std::size_t>(cell(p, 2)) * side_ + cell(p, 1)].push_back(ray);
    }
  }

  /// For each component: does an odd number of triangles of others lie ahead of its ray's start?
  const std::vector<std::uint8_t>& odd_ahead(const std::vector<std::uint32_t>& component_of) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) cross(t, component_of[t]);
    return odd_;
  }

 private:
  /// Points beside all rays are filed with the nearest.
  int cell(const Point3& p, int axis) const {
    const double extent = box_.max[axis] - box_.min[axis];
    if (!(extent > 0)) return 0;
    return static_cast<int>(std::clamp(side_ * ((p[axis] - box_.min[axis]) / extent), 0.0, side_ - 1.0));
  }

  void cross(std::uint32_t t, std::uint32_t component) {
    int low[3], high[3];
    for (int axis : {1, 2}) {
      low[axis] = high[axis] = cell(points_[triangles_[t][0]], axis);
      for (std::uint32_t v : triangles_[t]) {
        low[axis] = std::min(low[axis], cell(points_[v], axis));
        high[axis] = std::max(high[axis], cell(points_[v], axis));
      }
    }
    for (int row = low[2]; row <= high[2]; ++row) {
      for (int column = low[1]; column <= high[1]; ++column) {
        for (std::uint32_t ray : bins_[static_cast<std::size_t>(row) * side_ + column]) {
          const Point3& p = points_[starts_[ray]];
          if (ray != component && in_shadow(t, p) && ahead(t, p)) odd_[ray] ^= 1;
        }
      }
    }
  }

  // Crossing number with half-open edges, each judged from its smaller vertex: two triangles that share an edge never
  // both own, nor both miss, a point on it.
  bool in_shadow(std::uint32_t t, const Point3& p) const {
    bool inside = false;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t from = triangles_[t][i], to = triangles_[t][(i + 1) % 3];
      if (points_[to].z < points_[from].z || (points_[to].z == points_[from].z && to < from)) std::swap(from, to);
      const Point3 &a = points_[from], &b = points_[to];
      if ((a.z > p.z) != (b.z > p.z) && planar_orientation(a, b, p, 1, 2) > 0) inside = !inside;
    }
    return inside;
  }

  bool ahead(std::uint32_t t, const Point3& p) const {
    const Point3 &a = points_[triangles_[t][0]], &b = points_[triangles_[t][1]], &c = points_[triangles_[t][2]];
    return orientation(a, b, c, p) * planar_orientation(a, b, c, 1, 2) < 0;
  }

  const std::vector<Point3>& points_;
  std::span<const Triangle> triangles_;
  const std::vector<std::uint32_t>& starts_;
  std::vector<std::uint8_t> odd_;
  Box3 box_;
  int side_ = 1;
  std::vector<std::vector<std::uint32_t>> bins_;
};

}  // namespace

SurfaceTopology surface_topology(const std::vector<Point3>& points, std::span<const Triangle> triangles) {
  SurfaceTopology result;
  Joins joins{UnionFind(triangles.size()), UnionFind(3 * triangles.size())};
  Edges edges = find_edges(points, triangles, joins);
  result.edges = edges.owners.size();
  result.rim = std::move(edges.rim);
  result.crowded_edges = edges.crowded;
  result.misoriented_edges = edges.misoriented;
  count_vertices(points, triangles, joins.corners, result);
  result.euler =
      static_cast<long>(result.vertices) - static_cast<long>(result.edges) + static_cast<long>(triangles.size());
  result.duplicate_triangles = duplicate_triangles(points, triangles);
  measure_components(points, triangles, joins, edges.owners, result);
  sort_components(result);
  return result;
}

Tally wrongly_oriented_components(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                  const SurfaceTopology& topology) {
  Tally wrong;
  const std::size_t count = topology.components.size();
  std::vector<std::uint32_t> foremost(count, kNone);  // the vertex with the largest x: nothing of its own is ahead
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    std::uint32_t& best = foremost[topology.component_of[t]];
    for (std::uint32_t v : triangles[t]) {
      if (best == kNone || points[v].x > points[best].x) best = v;
    }
  }
  if (count == 1) {
    if (topology.components[0].volume_mm3 <= 0) wrong.add(points[foremost[0]]);
    return wrong;
  }
  Rays rays(points, triangles, foremost);
  const std::vector<std::uint8_t>& is_cavity = rays.odd_ahead(topology.component_of);
  for (std::uint32_t c = 0; c < count; ++c) {
    const double volume = topology.components[c].volume_mm3;
    if (is_cavity[c] != 0 ? volume >= 0 : volume <= 0) wrong.add(points[foremost[c]]);
  }
  return wrong;
}

}  // namespace delvox::check
