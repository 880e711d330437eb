#include "oracle/samples_triangulation.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>

#include "delvox/core/errors.h"
#include "delvox/core/mesh.h"

namespace delvox {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

Kernel::Point_3 cgal(const Point3& p) {
  return {p.x, p.y, p.z};
}

int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return CGAL::orientation(cgal(a), cgal(b), cgal(c), cgal(d));
}

double six_volumes_of(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Where ab meets the plane of pqr, as a share of ab, from exact numbers.
double exact_share(const Point3& p, const Point3& q, const Point3& r, const Point3& a, const Point3& b) {
  using Exact = CGAL::Simple_cartesian<CGAL::Gmpq>;
  const auto from_p = [&](const Point3& v) { return Exact::Point_3(v.x, v.y, v.z) - Exact::Point_3(p.x, p.y, p.z); };
  const CGAL::Gmpq at_a = CGAL::determinant(from_p(q), from_p(r), from_p(a));
  const CGAL::Gmpq at_b = CGAL::determinant(from_p(q), from_p(r), from_p(b));
  return at_a == at_b ? 0 : CGAL::to_double(at_a / (at_a - at_b));
}

double volume_of(const Delaunay& delaunay) {
  double volume = 0;
  for (const auto cell : delaunay.finite_cell_handles()) volume += std::abs(delaunay.tetrahedron(cell).volume());
  return volume;
}

double cube_of_extent(const std::vector<Point3>& points) {
  Box3 box;
  for (const Point3& p : points) box.extend(p);
  return std::pow(box.diagonal(), 3);
}

Delaunay triangulate(const std::vector<Point3>& points) {
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> numbered;
  numbered.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) numbered.emplace_back(cgal(points[i]), i);
  Delaunay delaunay;
  delaunay.insert(numbered.begin(), numbered.end());
  if (delaunay.number_of_vertices() < 4)
    throw InputError("fewer than four different places; nothing lies between them");
  if (delaunay.dimension() < 3) throw InputError("all places lie in one plane; scatter them in space");
  constexpr double kFlat = 1e-12;  // of the cube of the extent: where rounding alone makes a thickness
  if (volume_of(delaunay) < kFlat * cube_of_extent(points)) {
    throw InputError("all places lie in one plane, nearly; scatter them in space");
  }
  return delaunay;
}

/// As a flat cell: an infinite vertex last, by an even permutation.
SampleTriangulation::Cell flat(const Delaunay& delaunay, Delaunay::Cell_handle cell) {
  constexpr int kEven[4][4] = {{1, 3, 2, 0}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 2, 3}};
  int infinite = 3;
  for (int i = 0; i < 4; ++i) {
    if (delaunay.is_infinite(cell->vertex(i))) infinite = i;
  }
  SampleTriangulation::Cell result;
  for (int i = 0; i < 4; ++i) {
    const auto vertex = cell->vertex(kEven[infinite][i]);
    result.vertices[i] = delaunay.is_infinite(vertex) ? SampleTriangulation::kNone : vertex->info();
    result.neighbors[i] = cell->neighbor(kEven[infinite][i])->info();
  }
  return result;
}

}  // namespace

SampleTriangulation::SampleTriangulation(std::vector<Point3> points) : points_(std::move(points)) {
  for (const Point3& p : points_) box_.extend(p);
  Delaunay delaunay = triangulate(points_);
  std::uint32_t count = 0;
  for (auto cell : delaunay.finite_cell_handles()) cell->info() = count++;
  finite_count_ = count;
  for (auto cell : delaunay.all_cell_handles()) {
    if (delaunay.is_infinite(cell)) cell->info() = count++;
  }
  cells_.resize(count);
  for (auto cell : delaunay.all_cell_handles()) cells_[cell->info()] = flat(delaunay, cell);
  make_starts();
}

double SampleTriangulation::six_volumes(std::uint32_t cell) const {
  return six_volumes_of(corner(cell, 0), corner(cell, 1), corner(cell, 2), corner(cell, 3));
}

std::size_t SampleTriangulation::bin_of(const Point3& p) const {
  std::size_t bin = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double place = (p[axis] - box_.min[axis]) * bins_per_mm_[axis];
    const double last = static_cast<double>(bins_[axis] - 1);
    bin = bin * bins_[axis] + static_cast<std::size_t>(std::clamp(std::floor(place), 0.0, last));
  }
  return bin;
}

/// About one bin for each two points: a walk from its start then takes a few steps.
void SampleTriangulation::make_starts() {
  const Vector3 extent = box_.max - box_.min;
  const double wanted = std::max(1.0, 0.5 * static_cast<double>(points_.size()));
  const double width = std::cbrt(extent.x * extent.y * extent.z / wanted);
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    bins_[axis] = static_cast<std::size_t>(std::clamp(std::ceil(extent[axis] / width), 1.0, wanted));
    bins_per_mm_[axis] = static_cast<double>(bins_[axis]) / extent[axis];
    count *= bins_[axis];
  }
  if (count > 8 * points_.size()) {  // a needle or a sheet: bins along its longest axis only
    const int longest = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    for (int axis = 0; axis < 3; ++axis) {
      bins_[axis] = axis == longest ? static_cast<std::size_t>(wanted) : 1;
      bins_per_mm_[axis] = static_cast<double>(bins_[axis]) / extent[axis];
    }
    count = bins_[longest];
  }
  starts_.resize(count);
  std::uint32_t cell = 0, row = 0, slice = 0;
  std::size_t bin = 0;
  for (std::size_t k = 0; k < bins_[2]; ++k) {
    for (std::size_t j = 0; j < bins_[1]; ++j) {
      for (std::size_t i = 0; i < bins_[0]; ++i) {
        const Vector3 place{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5};
        Point3 center;
        for (int axis = 0; axis < 3; ++axis) center[axis] = box_.min[axis] + place[axis] / bins_per_mm_[axis];
        cell = walk_to(center, i > 0 ? cell : j > 0 ? row : slice);
        if (!finite(cell)) cell = cells_[cell].neighbors[3];
        if (i == 0) row = cell;
        if (i == 0 && j == 0) slice = cell;
        starts_[bin++] = cell;
      }
    }
  }
}

std::uint32_t SampleTriangulation::locate(const Point3& p) const {
  return walk_to(p, starts_[bin_of(p)]);
}

/// A visibility walk: it ends, since of cells of a Delaunay triangulation none lies before and behind another, seen
/// from p (Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
std::uint32_t SampleTriangulation::walk_to(const Point3& p, std::uint32_t start) const {
  std::uint32_t cell = start, came_from = kNone;
  while (true) {
    const Cell& c = cells_[cell];
    int next = -1;
    for (int i = 0; i < 4 && next < 0; ++i) {
      if (c.neighbors[i] == came_from) continue;
      const auto& f = kTetFaces[i];
      if (orientation(corner(cell, f[0]), corner(cell, f[1]), corner(cell, f[2]), p) > 0) next = i;
    }
    if (next < 0) return cell;
    came_from = cell;
    cell = c.neighbors[next];
    if (!finite(cell)) return cell;
  }
}

/// The infinite cell through whose facet ab enters the hull, or kNone. pre: a lies strictly beyond the facet of
/// `infinite_cell`. Seen from a, the facets that it lies beyond are a regular triangulation, in which this walks.
std::uint32_t SampleTriangulation::entry(std::uint32_t cell, const Point3& a, const Point3& b) const {
  while (true) {
    const Cell& c = cells_[cell];
    if (orientation(corner(cell, 0), corner(cell, 1), corner(cell, 2), b) > 0) return kNone;  // all of ab lies beyond
    int next = -1;
    for (int i = 0; i < 3 && next < 0; ++i) {
      if (orientation(a, b, corner(cell, i), corner(cell, (i + 1) % 3)) > 0) next = (i + 2) % 3;
    }
    if (next < 0) return cell;
    cell = c.neighbors[next];
    if (orientation(corner(cell, 0), corner(cell, 1), corner(cell, 2), a) <= 0) return kNone;  // past the silhouette
  }
}

/// The face through which ab leaves a cell that it meets, or -1 if it ends there: b lies strictly beyond the face, and
/// the line meets it, its edges included.
int SampleTriangulation::exit_face(std::uint32_t cell, std::uint32_t came_from, const Point3& a,
                                   const Point3& b) const {
  for (int i = 0; i < 4; ++i) {
    if (cells_[cell].neighbors[i] == came_from) continue;
    const Point3 &p = corner(cell, kTetFaces[i][0]), &q = corner(cell, kTetFaces[i][1]),
                 &r = corner(cell, kTetFaces[i][2]);
    if (orientation(p, q, r, b) <= 0) continue;
    if (orientation(a, b, p, q) >= 0 && orientation(a, b, q, r) >= 0 && orientation(a, b, r, p) >= 0) return i;
  }
  return -1;
}

double SampleTriangulation::share_at_face(std::uint32_t cell, const std::array<int, 3>& face, const Point3& a,
                                          const Point3& b) const {
  const Point3 &p = corner(cell, face[0]), &q = corner(cell, face[1]), &r = corner(cell, face[2]);
  const double at_a = six_volumes_of(p, q, r, a), at_b = six_volumes_of(p, q, r, b);
  // Of a segment nearly in the plane, rounding would leave nothing.
  constexpr double kSteep = 1e-9;
  const double reach = std::sqrt(std::max(squared_distance(p, a), squared_distance(p, b)));
  const bool steep =
      std::abs(at_a - at_b) > kSteep * reach * std::sqrt(squared_distance(p, q) * squared_distance(p, r));
  return std::clamp(steep ? at_a / (at_a - at_b) : exact_share(p, q, r, a, b), 0.0, 1.0);
}

SampleTriangulation::Passage SampleTriangulation::passage(const Point3& a, const Point3& b) const {
  Passage passage;
  std::uint32_t cell = locate(a), came_from = kNone;
  double from = 0;
  passage.starts_inside = finite(cell);
  if (!passage.starts_inside) {
    came_from = entry(cell, a, b);
    if (came_from == kNone) return passage;
    from = share_at_face(came_from, {0, 1, 2}, a, b);
    cell = cells_[came_from].neighbors[3];
  }
  while (true) {
    const int exit = exit_face(cell, came_from, a, b);
    if (exit < 0) {
      passage.stretches.push_back({cell, from, 1});
      passage.ends_inside = true;
      return passage;
    }
    const auto& f = kTetFaces[exit];
    const double to = std::max(from, share_at_face(cell, {f[0], f[1], f[2]}, a, b));
    passage.stretches.push_back({cell, from, to});
    from = to;
    came_from = cell;
    cell = cells_[cell].neighbors[exit];
    if (!finite(cell)) return passage;
  }
}

bool SampleTriangulation::in_conflict(std::uint32_t cell, const Point3& p) const {
  const Point3 &a = corner(cell, 0), &b = corner(cell, 1), &c = corner(cell, 2);
  if (finite(cell)) {
    return CGAL::side_of_oriented_sphere(cgal(a), cgal(b), cgal(c), cgal(corner(cell, 3)), cgal(p)) ==
           CGAL::ON_POSITIVE_SIDE;
  }
  const int side = orientation(a, b, c, p);
  if (side != 0) return side > 0;
  return CGAL::coplanar_side_of_bounded_circle(cgal(a), cgal(b), cgal(c), cgal(p)) == CGAL::ON_BOUNDED_SIDE;
}

}  // namespace delvox
