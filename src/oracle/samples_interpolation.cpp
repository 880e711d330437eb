#include "oracle/samples_interpolation.h"

#include <CGAL/Gmpq.h>

#include <algorithm>
#include <cmath>

#include "core/flat_hash.h"
#include "delvox/core/mesh.h"

namespace delvox {
namespace {

template <class Number>
struct Vector {
  Number x, y, z;
  friend Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Number>
Vector<Number> minus(const Point3& a, const Point3& b) {
  return {Number(a.x) - Number(b.x), Number(a.y) - Number(b.y), Number(a.z) - Number(b.z)};
}

double as_double(double x) {
  return x;
}
double as_double(const CGAL::Gmpq& x) {
  return CGAL::to_double(x);
}

/// Six times the volumes of the tets that p makes with the faces opposite each vertex.
template <class Number>
std::array<Number, 4> face_volumes(const SampleTriangulation& triangulation, std::uint32_t cell, const Point3& p) {
  std::array<Vector<Number>, 4> v;
  for (int i = 0; i < 4; ++i) v[i] = minus<Number>(triangulation.corner(cell, i), p);
  std::array<Number, 4> volumes;
  for (int i = 0; i < 4; ++i) {
    const auto& f = kTetFaces[i];
    volumes[i] = dot(cross(v[f[0]], v[f[1]]), v[f[2]]);
  }
  return volumes;
}

/// The centre of the sphere through four points, less `origin`.
template <class Number>
Vector<Number> circumcenter(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& origin) {
  const Vector<Number> u = minus<Number>(b, a), v = minus<Number>(c, a), w = minus<Number>(d, a);
  const Vector<Number> vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const Number scale = Number(2) * dot(u, vw), uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  const Vector<Number> from = minus<Number>(a, origin);
  return {from.x + (uu * vw.x + vv * wu.x + ww * uv.x) / scale, from.y + (uu * vw.y + vv * wu.y + ww * uv.y) / scale,
          from.z + (uu * vw.z + vv * wu.z + ww * uv.z) / scale};
}

/// The cells whose circumspheres hold p: those that inserting it would replace.
class Hole {
 public:
  Hole(const SampleTriangulation& triangulation, std::uint32_t start, const Point3& p) : triangulation_(triangulation) {
    add(start);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      for (std::uint32_t neighbor : triangulation.cells()[cells_[i]].neighbors) {
        if (place_.find(neighbor) != FlatHash::kAbsent || !triangulation.in_conflict(neighbor, p)) continue;
        if (!triangulation.finite(neighbor)) {
          bounded_ = false;
          return;
        }
        add(neighbor);
      }
    }
  }

  /// Whether none of them is infinite; otherwise they are not all known.
  bool bounded() const { return bounded_; }
  const std::vector<std::uint32_t>& cells() const { return cells_; }
  /// Of a cell in cells(), or FlatHash::kAbsent.
  std::uint32_t place(std::uint32_t cell) const { return place_.find(cell); }

 private:
  void add(std::uint32_t cell) {
    place_[cell] = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back(cell);
  }

  const SampleTriangulation& triangulation_;
  std::vector<std::uint32_t> cells_;
  FlatHash place_;
  bool bounded_ = true;
};

/// The volumes that p takes from the Voronoi cells around it, times twelve. Each such piece is a polyhedron; by the
/// divergence theorem its volume, seen from its sample i, is the sum over its faces of area times distance. A face lies
/// midway between i and another sample m, or between i and p. Its area, times its normal, is half the sum of U x V over
/// its edges UV, whose ends are circumcentres: C of cells that go, X of p with the faces around the hole. All points
/// are taken relative to p.
template <class Number>
class Thefts {
 public:
  Thefts(const SampleTriangulation& triangulation, const Hole& hole, const Point3& p)
      : triangulation_(triangulation), hole_(hole), p_(p) {
    for (std::uint32_t cell : hole.cells()) {
      for (std::uint32_t v : triangulation.cells()[cell].vertices) {
        std::uint32_t& place = place_[v];
        if (place != FlatHash::kAbsent) continue;
        place = static_cast<std::uint32_t>(samples.size());
        samples.push_back(v);
      }
    }
    volumes.assign(samples.size(), Number(0));
    run();
  }

  std::vector<std::uint32_t> samples;
  std::vector<Number> volumes;

 private:
  /// An edge of a face around the hole, from a to b as that face has it, and its new circumcentre.
  struct Rim {
    std::uint64_t key;
    std::uint32_t a, b;
    std::uint32_t center;  // index into new_centers_
  };

  void run() {
    std::vector<Vector<Number>> centers;
    for (std::uint32_t cell : hole_.cells()) {
      centers.push_back(circumcenter<Number>(triangulation_.corner(cell, 0), triangulation_.corner(cell, 1),
                                             triangulation_.corner(cell, 2), triangulation_.corner(cell, 3), p_));
    }
    for (std::uint32_t i = 0; i < hole_.cells().size(); ++i) {
      const auto& cell = triangulation_.cells()[hole_.cells()[i]];
      for (int face = 0; face < 4; ++face) {
        const auto& f = kTetFaces[face];
        const Triangle corners{cell.vertices[f[0]], cell.vertices[f[1]], cell.vertices[f[2]]};
        const std::uint32_t other = hole_.place(cell.neighbors[face]);
        if (other == FlatHash::kAbsent) {
          add_rim(corners);
          add_face(corners, centers[i], new_centers_.back());
        } else if (other > i) {
          add_face(corners, centers[i], centers[other]);
        }
      }
    }
    close_rims();
  }

  const Point3& point(std::uint32_t v) const { return triangulation_.points()[v]; }
  Number& volume(std::uint32_t v) { return volumes[place_.find(v)]; }

  /// The edge from `from` through a face to `to`, of the Voronoi faces of the face's three edges.
  void add_face(const Triangle& corners, const Vector<Number>& from, const Vector<Number>& to) {
    const Vector<Number> area = cross(from, to);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
      const Number share = dot(area, minus<Number>(point(b), point(a)));
      volume(a) += share;
      volume(b) += share;
    }
  }

  void add_rim(const Triangle& corners) {
    new_centers_.push_back(circumcenter<Number>(point(corners[0]), point(corners[1]), point(corners[2]), p_, p_));
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
      rims_.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), a, b,
                       static_cast<std::uint32_t>(new_centers_.size() - 1)});
    }
  }

  /// Two faces around the hole meet in each edge ab: the edge between their new circumcentres belongs to the face
  /// midway between a and b, and the other way round to those between a and p and between b and p.
  void close_rims() {
    std::sort(rims_.begin(), rims_.end(),
              [](const Rim& s, const Rim& t) { return std::pair(s.key, s.center) < std::pair(t.key, t.center); });
    for (std::size_t i = 0; i + 1 < rims_.size(); i += 2) {
      const Rim& rim = rims_[i];
      const Vector<Number> area = cross(new_centers_[rim.center], new_centers_[rims_[i + 1].center]);
      const Vector<Number> a = minus<Number>(point(rim.a), p_), b = minus<Number>(point(rim.b), p_);
      const Number between = dot(area, b - a);
      volume(rim.a) += between + dot(area, a);
      volume(rim.b) += between - dot(area, b);
    }
  }

  const SampleTriangulation& triangulation_;
  const Hole& hole_;
  const Point3& p_;
  FlatHash place_;
  std::vector<Vector<Number>> new_centers_;
  std::vector<Rim> rims_;
};

using Coordinates = std::vector<std::pair<std::uint32_t, double>>;

template <class Number>
Coordinates coordinates(const SampleTriangulation& triangulation, const Hole& hole, const Point3& p) {
  const Thefts<Number> thefts(triangulation, hole, p);
  Number all(0);
  for (const Number& volume : thefts.volumes) all += volume;
  Coordinates result;
  for (std::size_t i = 0; i < thefts.samples.size(); ++i) {
    result.emplace_back(thefts.samples[i], as_double(thefts.volumes[i] / all));
  }
  return result;
}

/// Natural neighbour coordinates are positive and yield p (Sibson 1980): rounding that shows, shows there.
bool sound(const SampleTriangulation& triangulation, const Coordinates& coordinates, const Point3& p) {
  constexpr double kRounding = 1e-11;
  Vector3 sum;
  double reach = 0;
  for (const auto& [sample, weight] : coordinates) {
    if (!(weight >= -kRounding)) return false;
    const Vector3 to = triangulation.points()[sample] - p;
    sum = sum + weight * to;
    reach = std::max(reach, norm(to));
  }
  return norm(sum) <= kRounding * reach;
}

}  // namespace

double linear_value(const SampleTriangulation& triangulation, const std::vector<double>& values, std::uint32_t cell,
                    const Point3& p) {
  std::array<double, 4> weights = face_volumes<double>(triangulation, cell, p);
  double sum = 0, reach = 0;
  for (int i = 0; i < 4; ++i) {
    weights[i] = std::max(weights[i], 0.0);
    sum += weights[i];
    reach = std::max(reach, squared_distance(triangulation.corner(cell, i), p));
  }
  constexpr double kFlat = 1e-8;
  if (!(sum > kFlat * reach * std::sqrt(reach))) {
    const auto exact = face_volumes<CGAL::Gmpq>(triangulation, cell, p);
    const CGAL::Gmpq all = exact[0] + exact[1] + exact[2] + exact[3];
    sum = 0;
    for (int i = 0; i < 4; ++i) sum += weights[i] = CGAL::to_double(exact[i] / all);
  }
  double value = 0;
  for (int i = 0; i < 4; ++i) value += weights[i] * values[triangulation.cells()[cell].vertices[i]];
  return value / sum;
}

std::vector<std::pair<std::uint32_t, double>> natural_coordinates(const SampleTriangulation& triangulation,
                                                                  std::uint32_t cell, const Point3& p) {
  const Hole hole(triangulation, cell, p);
  if (!hole.bounded()) return {};
  Coordinates rounded = coordinates<double>(triangulation, hole, p);
  return sound(triangulation, rounded, p) ? rounded : coordinates<CGAL::Gmpq>(triangulation, hole, p);
}

double natural_value(const SampleTriangulation& triangulation, const std::vector<double>& values, std::uint32_t cell,
                     const Point3& p) {
  Point3 middle;
  for (int i = 0; i < 4; ++i) {
    if (triangulation.corner(cell, i) == p) return values[triangulation.cells()[cell].vertices[i]];
    middle = middle + 0.25 * triangulation.corner(cell, i);
  }
  Coordinates weights = natural_coordinates(triangulation, cell, p);
  if (weights.empty()) {
    constexpr double kInward = 1e-9;
    weights = natural_coordinates(triangulation, cell, p + kInward * (middle - p));
  }
  if (weights.empty()) return linear_value(triangulation, values, cell, p);  // a cell as flat as a rounding error
  double value = 0;
  for (const auto& [sample, weight] : weights) value += weight * values[sample];
  return value;
}

double natural_level(const SampleTriangulation& triangulation, const std::vector<double>& levels, std::uint32_t cell,
                     const Point3& p) {
  const auto inside = [&](std::uint32_t c, bool wanted) {
    const auto& v = triangulation.cells()[c].vertices;
    return std::all_of(v.begin(), v.end(), [&](std::uint32_t sample) { return (levels[sample] > 0) == wanted; });
  };
  const bool sign = levels[triangulation.cells()[cell].vertices[0]] > 0;
  if (inside(cell, sign)) {
    const Hole hole(triangulation, cell, p);
    const auto& cells = hole.cells();
    const bool one_sign =
        hole.bounded() && std::all_of(cells.begin(), cells.end(), [&](std::uint32_t c) { return inside(c, sign); });
    if (one_sign) return linear_value(triangulation, levels, cell, p);
  }
  return natural_value(triangulation, levels, cell, p);
}

}  // namespace delvox
