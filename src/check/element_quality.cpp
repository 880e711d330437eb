#include "check/element_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace delvox::check {
namespace {

constexpr double kRelativeTolerance = 1e-9;
constexpr double kDegrees = 180 / std::numbers::pi;

// Bins the arc cosine without computing it: cosines are looked up in a fine table and only the neighbours compared.
class AngleBins {
 public:
  static constexpr int kBins = 36;  // of 5 degrees
  AngleBins() {
    for (int i = 0; i <= kBins; ++i) edge_[i] = std::cos(i * std::numbers::pi / kBins);
    for (int i = 0, bin = kBins - 1; i < kTable; ++i) {
      const double cosine = -1 + 2.0 * i / kTable;
      while (bin > 0 && cosine > edge_[bin]) --bin;
      start_[i] = static_cast<std::uint8_t>(bin);
    }
  }
  int operator()(double cosine) const {
    const int i = std::clamp(static_cast<int>((cosine + 1) * (kTable / 2)), 0, kTable - 1);
    int bin = start_[i];
    while (bin > 0 && cosine > edge_[bin]) --bin;
    return bin;
  }

 private:
  static constexpr int kTable = 1024;
  double edge_[kBins + 1];
  std::uint8_t start_[kTable];
};

Distribution make_distribution(double low, double high, std::size_t bins) {
  Distribution d;
  d.low = low;
  d.high = high;
  d.bins.assign(bins, 0);
  d.min = std::numeric_limits<double>::infinity();
  d.max = -d.min;
  return d;
}

void add(Distribution& d, double value) {
  ++d.count;
  d.min = std::min(d.min, value);
  d.max = std::max(d.max, value);
  d.mean += value;
  const double place = (value - d.low) / (d.high - d.low) * static_cast<double>(d.bins.size());
  ++d.bins[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(d.bins.size()) - 1))];
}

void finish(Distribution& d) {
  if (d.count == 0) d.min = d.max = 0;
  else d.mean /= static_cast<double>(d.count);
}

// Angles come as cosines: least and greatest are kept as such, the mean is that of the bins' middles.
struct CosineDistribution {
  double largest = -2, smallest = 2;
  std::array<std::size_t, AngleBins::kBins> bins{};
  void add(const AngleBins& bin_of, double cosine) {
    largest = std::max(largest, cosine);
    smallest = std::min(smallest, cosine);
    ++bins[bin_of(cosine)];
  }
  Distribution degrees() const {
    Distribution d = make_distribution(0, 180, AngleBins::kBins);
    d.min = d.max = 0;
    for (int i = 0; i < AngleBins::kBins; ++i) {
      d.bins[i] = bins[i];
      d.count += bins[i];
      d.mean += static_cast<double>(bins[i]) * (i + 0.5) * (180.0 / AngleBins::kBins);
    }
    if (d.count == 0) return d;
    d.mean /= static_cast<double>(d.count);
    d.min = std::acos(std::clamp(largest, -1.0, 1.0)) * kDegrees;
    d.max = std::acos(std::clamp(smallest, -1.0, 1.0)) * kDegrees;
    return d;
  }
};

void keep_largest(Extreme& extreme, double value, const Point3& where) {
  if (extreme.any && !(value > extreme.value)) return;
  extreme = {value, true, where, extreme.violations};
}

void keep_smallest(Extreme& extreme, double value, const Point3& where) {
  if (extreme.any && !(value < extreme.value)) return;
  extreme = {value, true, where, extreme.violations};
}

struct TriangleShape {
  double length[3];  // length[i] lies opposite corner i
  double cosine[3];
  double double_area;
  double circumradius;
};

TriangleShape shape_of(const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 e[3] = {c - b, a - c, b - a};
  TriangleShape s;
  for (int i = 0; i < 3; ++i) s.length[i] = norm(e[i]);
  for (int i = 0; i < 3; ++i) {
    s.cosine[i] = -dot(e[(i + 1) % 3], e[(i + 2) % 3]) / (s.length[(i + 1) % 3] * s.length[(i + 2) % 3]);
  }
  s.double_area = norm(cross(e[2], -1.0 * e[1]));
  s.circumradius = s.length[0] * s.length[1] * s.length[2] / (2 * s.double_area);
  return s;
}

// An edge of length l turns by at most 2 d / l when its ends move by d; an angle by what its two edges do.
double angle_tolerance_degrees(const TriangleShape& s, Precision precision) {
  return 4 * precision.displacement_mm / *std::min_element(s.length, s.length + 3) * kDegrees;
}

// R = l / (2 sin A) with l the longest edge and A the angle opposite.
double circumradius_tolerance(const TriangleShape& s, Precision precision) {
  const int longest = static_cast<int>(std::max_element(s.length, s.length + 3) - s.length);
  const double cotangent =
      std::abs(s.cosine[longest]) / std::sqrt(std::max(1e-300, 1 - s.cosine[longest] * s.cosine[longest]));
  const double shortest = *std::min_element(s.length, s.length + 3);
  return s.circumradius * precision.displacement_mm * (2 / s.length[longest] + 4 * cotangent / shortest);
}

struct TetShape {
  double six_volumes;
  double shortest, longest;
  double circumradius;
  double cosine[6];  // of the dihedral angles
};

TetShape shape_of(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Vector3 u = b - a, v = c - a, w = d - a;
  const Vector3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const Vector3 outward[4] = {cross(c - b, d - b), -1.0 * vw, -1.0 * wu, -1.0 * uv};
  TetShape s;
  s.six_volumes = dot(u, vw);
  const double uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  const double lengths[6] = {uu, vv, ww, squared_distance(b, c), squared_distance(b, d), squared_distance(c, d)};
  s.shortest = std::sqrt(*std::min_element(lengths, lengths + 6));
  s.longest = std::sqrt(*std::max_element(lengths, lengths + 6));
  s.circumradius = norm(uu * vw + vv * wu + ww * uv) / (2 * std::abs(s.six_volumes));
  double inverse_norm[4];
  for (int i = 0; i < 4; ++i) inverse_norm[i] = 1 / norm(outward[i]);
  int pair = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      s.cosine[pair++] = -dot(outward[i], outward[j]) * inverse_norm[i] * inverse_norm[j];
    }
  }
  return s;
}

// With z = sum lambda_i p_i the circumcentre, R dR = sum lambda_i (p_i - z) . dp_i, so |dR| <= d sum |lambda_i|.
double circumradius_tolerance(const std::array<Point3, 4>& p, const TetShape& s, Precision precision) {
  const Vector3 u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  const Vector3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double scale = 1 / s.six_volumes;
  const Vector3 z = (0.5 * scale) * (squared_norm(u) * vw + squared_norm(v) * wu + squared_norm(w) * uv);
  const double lambda[3] = {dot(z, vw) * scale, dot(z, wu) * scale, dot(z, uv) * scale};
  const double first = 1 - lambda[0] - lambda[1] - lambda[2];
  return precision.displacement_mm *
         (std::abs(first) + std::abs(lambda[0]) + std::abs(lambda[1]) + std::abs(lambda[2]));
}

// A face turns by at most 2 d over its smallest altitude, which is at least the tet's smallest altitude.
double dihedral_tolerance_degrees(const std::array<Point3, 4>& p, Precision precision) {
  double altitude = std::numeric_limits<double>::infinity();
  for (const auto& f : kTetFaces) {
    const TriangleShape face = shape_of(p[f[0]], p[f[1]], p[f[2]]);
    altitude = std::min(altitude, face.double_area / *std::max_element(face.length, face.length + 3));
  }
  return 4 * precision.displacement_mm / altitude * kDegrees;
}

Point3 centroid(const std::array<Point3, 4>& p) { return 0.25 * ((p[0] + p[1]) + (p[2] + p[3])); }

void hold_to_bounds(const std::array<Point3, 4>& p, const TetShape& s, double largest_cosine, const Promises& bounds,
                    Precision precision, TetQuality& result) {
  constexpr double kSlack = 1 + kRelativeTolerance;
  const double ratio = s.circumradius / s.shortest;
  if (bounds.radius_edge && !(ratio <= *bounds.radius_edge * kSlack)) {
    const double move = circumradius_tolerance(p, s, precision) / s.shortest +
                        ratio * 2 * precision.displacement_mm / s.shortest;
    if (!(ratio <= *bounds.radius_edge * kSlack + move)) ++result.radius_edge.violations;
  }
  if (bounds.cell_size && !(s.circumradius <= *bounds.cell_size * kSlack)) {
    const double move = circumradius_tolerance(p, s, precision);
    if (!(s.circumradius <= *bounds.cell_size * kSlack + move)) ++result.circumradius.violations;
  }
  if (bounds.min_dihedral_degrees) {
    const double dihedral = std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * kDegrees;
    if (!(dihedral * kSlack >= *bounds.min_dihedral_degrees) &&
        !(dihedral * kSlack >= *bounds.min_dihedral_degrees - dihedral_tolerance_degrees(p, precision))) {
      ++result.dihedral.violations;
    }
  }
}

double median_scale(const std::vector<Point3>& points, std::span<const Tet> tets) {
  // Edge bins need a scale before the edges are known: the mean over a sample is good enough for bins.
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < tets.size(); t += 1 + tets.size() / 1000) {
    sum += distance(points[tets[t][0]], points[tets[t][1]]) + distance(points[tets[t][2]], points[tets[t][3]]);
    count += 2;
  }
  return count > 0 && sum > 0 ? sum / static_cast<double>(count) : 1;
}

}  // namespace

Point3 circumcenter(const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 u = b - a, v = c - a, n = cross(u, v);
  const Vector3 offset = squared_norm(u) * cross(v, n) + squared_norm(v) * cross(n, u);
  return a + (1 / (2 * squared_norm(n))) * offset;
}

TriangleQuality measure_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                  const Promises& bounds, Precision precision) {
  constexpr double kFlat = 1e-14;  // altitude over longest edge below which double holds no area
  const AngleBins bin_of;
  TriangleQuality result;
  CosineDistribution angles;
  double scale = 0;
  for (const Triangle& t : triangles) scale += distance(points[t[0]], points[t[1]]);
  scale = scale > 0 ? scale / static_cast<double>(triangles.size()) : 1;
  result.edges = make_distribution(0, 3 * scale, 30);
  for (const Triangle& t : triangles) {
    const Point3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    const TriangleShape s = shape_of(a, b, c);
    const Point3 where = (1.0 / 3) * (a + b + c);
    const double longest = *std::max_element(s.length, s.length + 3);
    for (double length : s.length) add(result.edges, length);
    if (!(s.double_area > longest * std::max(kFlat * longest, precision.displacement_mm))) {
      if (result.degenerate++ == 0) result.degenerate_where = where;
      keep_smallest(result.angle, 0, where);
      if (bounds.min_angle_degrees) ++result.angle.violations;
      continue;
    }
    for (double cosine : s.cosine) angles.add(bin_of, cosine);
    const double largest_cosine = *std::max_element(s.cosine, s.cosine + 3);
    const double angle = std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * kDegrees;
    keep_smallest(result.angle, angle, where);
    keep_largest(result.circumradius, s.circumradius, where);
    if (bounds.min_angle_degrees && !(angle * (1 + kRelativeTolerance) + angle_tolerance_degrees(s, precision) >=
                                      *bounds.min_angle_degrees)) {
      ++result.angle.violations;
    }
    if (bounds.size &&
        !(s.circumradius <= *bounds.size * (1 + kRelativeTolerance) + circumradius_tolerance(s, precision))) {
      ++result.circumradius.violations;
    }
  }
  result.angles = angles.degrees();
  finish(result.edges);
  return result;
}

TetQuality measure_tets(const std::vector<Point3>& points, std::span<const Tet> tets, const Promises& bounds,
                        Precision precision) {
  const AngleBins bin_of;
  TetQuality result;
  CosineDistribution dihedrals;
  double largest_cosine_of_all = -2;
  result.ratios = make_distribution(0.6, 2.6, 40);
  result.edges = make_distribution(0, 3 * median_scale(points, tets), 30);
  for (const Tet& t : tets) {
    const std::array<Point3, 4> p{points[t[0]], points[t[1]], points[t[2]], points[t[3]]};
    const TetShape s = shape_of(p[0], p[1], p[2], p[3]);
    result.volume_mm3 += s.six_volumes / 6;
    add(result.edges, s.shortest);
    add(result.edges, s.longest);
    // A flat tet has no finite radius and no angles; "positive tets" names it, here it counts as infinitely bad.
    const bool flat = !std::isfinite(s.circumradius) || s.six_volumes == 0;
    double largest_cosine = flat ? 1 : -1;
    for (double cosine : s.cosine) {
      if (!std::isfinite(cosine)) continue;
      largest_cosine = std::max(largest_cosine, cosine);
      dihedrals.add(bin_of, cosine);
    }
    const double radius = flat ? std::numeric_limits<double>::infinity() : s.circumradius;
    const double ratio = radius / s.shortest;
    add(result.ratios, std::isfinite(ratio) ? ratio : std::numeric_limits<double>::max());
    keep_largest(result.radius_edge, ratio, centroid(p));
    keep_largest(result.circumradius, radius, centroid(p));
    if (largest_cosine > largest_cosine_of_all) {
      largest_cosine_of_all = largest_cosine;
      keep_smallest(result.dihedral, std::acos(std::clamp(largest_cosine, -1.0, 1.0)) * kDegrees, centroid(p));
    }
    TetShape judged = s;
    judged.circumradius = radius;
    hold_to_bounds(p, judged, largest_cosine, bounds, precision, result);
  }
  result.dihedrals = dihedrals.degrees();
  finish(result.ratios);
  finish(result.edges);
  return result;
}

}  // namespace delvox::check
