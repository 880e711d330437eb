#include "oracle/samples_surface.h"

#include <algorithm>
#include <cmath>

#include "core/flat_hash.h"
#include "core/union_find.h"

namespace delvox {
namespace {

/// A corner of a polygon: where an edge between two samples is crossed, the first of them being inside; or a sample, as
/// both of them.
using Corner = std::array<std::uint32_t, 2>;

/// Up to four corners, in order.
struct Polygon {
  std::array<Corner, 4> corners;
  int size = 0;
  void add(std::uint32_t inside, std::uint32_t other) { corners[size++] = {inside, other}; }
};

/// What separates the inside of a tet from its outside, counter-clockwise seen from the outside. `cell`: positive.
Polygon cut(const std::array<std::uint32_t, 4>& cell, const std::vector<double>& levels) {
  std::array<int, 4> in, out;
  int inside = 0, outside = 0;
  for (int i = 0; i < 4; ++i) (levels[cell[i]] > 0 ? in[inside++] : out[outside++]) = i;
  Polygon polygon;
  if (inside == 1 || inside == 3) {
    const int apex = inside == 1 ? in[0] : out[0];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t base = cell[kTetFaces[apex][inside == 1 ? k : 2 - k]];
      polygon.add(inside == 1 ? cell[apex] : base, inside == 1 ? base : cell[apex]);
    }
  } else if (inside == 2) {
    // Both pairs rise: (in0, in1, out0, out1) is an odd permutation just where they interleave.
    if ((in[0] == 0 && in[1] == 2) || (in[0] == 1 && in[1] == 3)) std::swap(out[0], out[1]);
    polygon.add(cell[in[0]], cell[out[0]]);
    polygon.add(cell[in[0]], cell[out[1]]);
    polygon.add(cell[in[1]], cell[out[1]]);
    polygon.add(cell[in[1]], cell[out[0]]);
  }
  return polygon;
}

/// The part of a triangle that is inside, its corners in the same order.
Polygon clip(const Triangle& facet, const std::vector<double>& levels) {
  Polygon polygon;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t v = facet[i], w = facet[(i + 1) % 3];
    const bool v_inside = levels[v] > 0, w_inside = levels[w] > 0;
    if (v_inside) polygon.add(v, v);
    if (v_inside != w_inside) polygon.add(v_inside ? v : w, v_inside ? w : v);
  }
  return polygon;
}

Triangle hull_facet(const SampleTriangulation& triangulation, std::uint32_t cell) {
  const auto& v = triangulation.cells()[cell].vertices;
  return {v[0], v[1], v[2]};
}

class SurfaceMaker {
 public:
  SurfaceMaker(const SampleTriangulation& triangulation, const std::vector<double>& levels, const PlaceOnEdge& place)
      : triangulation_(triangulation), levels_(levels), place_(place) {}

  PolygonSurface run() {
    const auto& cells = triangulation_.cells();
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      const bool finite = triangulation_.finite(c);
      cell_ = finite ? c : cells[c].neighbors[3];
      add(finite ? cut(cells[c].vertices, levels_) : clip(hull_facet(triangulation_, c), levels_));
    }
    count_components();
    return std::move(surface_);
  }

 private:
  void add(const Polygon& polygon) {
    std::array<std::uint32_t, 4> numbers;
    for (int i = 0; i < polygon.size; ++i) numbers[i] = number_of(polygon.corners[i]);
    for (int i = 2; i < polygon.size; ++i) surface_.triangles.push_back({numbers[0], numbers[i - 1], numbers[i]});
  }

  std::uint32_t number_of(const Corner& corner) {
    const auto [low, high] = std::minmax(corner[0], corner[1]);
    std::uint32_t& number = numbers_[std::uint64_t{low} << 32 | high];
    if (number == FlatHash::kAbsent) {
      number = static_cast<std::uint32_t>(surface_.points.size());
      surface_.points.push_back(low == high ? triangulation_.points()[low] : place_(cell_, corner[0], corner[1]));
    }
    return number;
  }

  void count_components() {
    UnionFind joined(surface_.points.size());
    for (const Triangle& t : surface_.triangles) {
      joined.join(t[0], t[1]);
      joined.join(t[0], t[2]);
    }
    std::vector<std::uint32_t> component(surface_.points.size(), FlatHash::kAbsent);
    for (const Triangle& t : surface_.triangles) {
      std::uint32_t& c = component[joined.root(t[0])];
      if (c == FlatHash::kAbsent) c = surface_.components++;
      surface_.component_of.push_back(c);
    }
  }

  const SampleTriangulation& triangulation_;
  const std::vector<double>& levels_;
  const PlaceOnEdge& place_;
  std::uint32_t cell_ = 0;  // finite, and with all corners of the polygon being added
  FlatHash numbers_;
  PolygonSurface surface_;
};

void add_area(const SampleTriangulation& triangulation, const std::vector<double>& levels, const Polygon& polygon,
              DomainPatch& patch) {
  std::array<Point3, 4> points;
  for (int i = 0; i < polygon.size; ++i) {
    const auto [v, w] = polygon.corners[i];
    points[i] = v == w ? triangulation.points()[v] : linear_place(triangulation, levels, v, w);
  }
  for (int i = 2; i < polygon.size; ++i) {
    const Vector3 normal = 0.5 * cross(points[i - 1] - points[0], points[i] - points[0]);
    for (int axis = 0; axis < 3; ++axis) {
      (normal[axis] > 0 ? patch.area_up : patch.area_down)[axis] += std::abs(normal[axis]);
    }
  }
}

}  // namespace

PolygonSurface samples_surface(const SampleTriangulation& triangulation, const std::vector<double>& levels,
                               const PlaceOnEdge& place) {
  return SurfaceMaker(triangulation, levels, place).run();
}

Point3 linear_place(const SampleTriangulation& triangulation, const std::vector<double>& levels, std::uint32_t v,
                    std::uint32_t w) {
  if (v > w) std::swap(v, w);
  const Point3 &p = triangulation.points()[v], &q = triangulation.points()[w];
  return p + (levels[v] / (levels[v] - levels[w])) * (q - p);
}

double inside_mm3_of(const SampleTriangulation& triangulation, const std::vector<double>& levels, std::uint32_t cell) {
  const auto& v = triangulation.cells()[cell].vertices;
  std::array<std::uint32_t, 4> sorted = v;
  const auto outside_begin =
      std::stable_partition(sorted.begin(), sorted.end(), [&](std::uint32_t s) { return levels[s] > 0; });
  const auto inside = outside_begin - sorted.begin();
  const double whole = triangulation.six_volumes(cell) / 6;
  if (inside == 0 || inside == 4) return inside == 0 ? 0 : whole;
  // How far along the edge from s to t the level is met.
  const auto share = [&](int s, int t) { return levels[sorted[s]] / (levels[sorted[s]] - levels[sorted[t]]); };
  if (inside == 1) return whole * share(0, 1) * share(0, 2) * share(0, 3);
  if (inside == 3) return whole * (1 - share(3, 0) * share(3, 1) * share(3, 2));
  // A wedge of three tets: (0, 02, 03, 12), (0, 1, 12, 13) and (0, 03, 12, 13) by their corners and cut edges.
  const double a = share(0, 2), b = share(0, 3), c = share(1, 2), d = share(1, 3);
  return whole * (a * b * (1 - c) + c * d + b * (1 - d) * c);
}

void visit_samples_patches(const SampleTriangulation& triangulation, const std::vector<double>& levels, double width,
                           const std::function<void(const DomainPatch&)>& visit) {
  for (std::uint32_t c = 0; c < triangulation.finite_count(); ++c) {
    const auto& cell = triangulation.cells()[c];
    DomainPatch patch;
    patch.inside_mm3 = inside_mm3_of(triangulation, levels, c);
    add_area(triangulation, levels, cut(cell.vertices, levels), patch);
    for (std::uint32_t neighbor : cell.neighbors) {
      if (triangulation.finite(neighbor)) continue;
      add_area(triangulation, levels, clip(hull_facet(triangulation, neighbor), levels), patch);
    }
    if (!(patch.inside_mm3 > 0) && !(norm(patch.area_up + patch.area_down) > 0)) continue;
    for (int i = 0; i < 4; ++i) patch.center = patch.center + 0.25 * triangulation.corner(c, i);
    patch.width = std::max(width, std::cbrt(triangulation.six_volumes(c) / 6));
    visit(patch);
  }
}

}  // namespace delvox
