#include "check/element_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <tuple>

#include "check/exact_orientation.h"
#include "core/pair_geometry.h"
#include "core/parallel.h"

namespace delvox::check {
namespace {

constexpr double kRelativeTolerance = 1e-9;
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kChunk = 8192;  // elements measured together

double degrees_of_cosine(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * kDegrees;
}

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

// Adds up to a Distribution, chunk by chunk.
class Spread {
 public:
  Spread(double low, double high, std::size_t bins)
      : low_(low), high_(high), per_unit_(static_cast<double>(bins) / (high - low)), bins_(bins, 0) {}
  void add(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    sum_ += value;
    const double last = static_cast<double>(bins_.size()) - 1;
    ++bins_[static_cast<std::size_t>(std::clamp((value - low_) * per_unit_, 0.0, last))];
  }
  void append(const Spread& later) {
    min_ = std::min(min_, later.min_);
    max_ = std::max(max_, later.max_);
    sum_ += later.sum_;
    for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += later.bins_[i];
  }
  Distribution distribution() const {
    const std::size_t count = std::accumulate(bins_.begin(), bins_.end(), std::size_t{0});
    if (count == 0) return {0, 0, 0, 0, low_, high_, bins_};
    return {count, min_, max_, sum_ / static_cast<double>(count), low_, high_, bins_};
  }

 private:
  double low_, high_, per_unit_;
  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_, sum_ = 0;
  std::vector<std::size_t> bins_;
};

// Angles come as cosines: least and greatest are kept as such, the mean is that of the bins' middles.
struct CosineSpread {
  double largest = -2, smallest = 2;
  std::array<std::size_t, AngleBins::kBins> bins{};
  void add(const AngleBins& bin_of, double cosine) {
    largest = std::max(largest, cosine);
    smallest = std::min(smallest, cosine);
    ++bins[bin_of(cosine)];
  }
  void append(const CosineSpread& later) {
    largest = std::max(largest, later.largest);
    smallest = std::min(smallest, later.smallest);
    for (int i = 0; i < AngleBins::kBins; ++i) bins[i] += later.bins[i];
  }
  Distribution degrees() const {
    Distribution d;
    d.high = 180;
    d.bins.assign(bins.begin(), bins.end());
    for (int i = 0; i < AngleBins::kBins; ++i) {
      d.count += bins[i];
      d.mean += static_cast<double>(bins[i]) * (i + 0.5) * (180.0 / AngleBins::kBins);
    }
    if (d.count == 0) return d;
    d.mean /= static_cast<double>(d.count);
    d.min = degrees_of_cosine(largest);
    d.max = degrees_of_cosine(smallest);
    return d;
  }
};

// where() is asked only if the value is the worst so far.
template <class Where>
void keep_smallest(Extreme& extreme, double value, const Where& where) {
  if (extreme.any && !(value < extreme.value)) return;
  extreme = {value, true, where(), extreme.violations};
}

void append_smallest(Extreme& extreme, const Extreme& later) {
  if (later.any) keep_smallest(extreme, later.value, [&] { return later.where; });
  extreme.violations += later.violations;
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

using Corners = std::array<Point3, 4>;

// Of two tets at a time.
std::array<TetShape, 2> shapes_of(const Corners& first, const Corners& second) {
  PairVector p[4];
  for (int i = 0; i < 4; ++i) p[i] = PairVector::of(first[i], second[i]);
  const PairVector u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  const PairVector vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const Pair minus{-1, -1};
  const PairVector outward[4] = {cross(p[2] - p[1], p[3] - p[1]), minus * vw, minus * wu, minus * uv};
  const Pair six_volumes = dot(u, vw), uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
  Pair shortest = uu, longest = uu;
  for (const Pair length : {vv, ww, squared_norm(p[1] - p[2]), squared_norm(p[1] - p[3]), squared_norm(p[2] - p[3])}) {
    shortest = min(shortest, length);
    longest = max(longest, length);
  }
  shortest = sqrt(shortest);
  longest = sqrt(longest);
  const Pair circumradius = norm(uu * vw + vv * wu + ww * uv) / (2 * abs(six_volumes));
  Pair inverse_norm[4], cosine[6];
  for (int i = 0; i < 4; ++i) inverse_norm[i] = 1 / norm(outward[i]);
  int pair = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      cosine[pair++] = -dot(outward[i], outward[j]) * inverse_norm[i] * inverse_norm[j];
    }
  }
  // The volume's rounding error is below 1e-15 |u||v||w|: of one smaller than this fewer than nine digits are left.
  constexpr double kFlat = 1e-6;
  const auto flat = six_volumes * six_volumes < kFlat * kFlat * uu * vv * ww;
  std::array<TetShape, 2> shapes;
  for (int n = 0; n < 2; ++n) {
    TetShape& s = shapes[n];
    s = {six_volumes[n], shortest[n], longest[n], circumradius[n], {}};
    for (int i = 0; i < 6; ++i) s.cosine[i] = cosine[i][n];
    const Corners& c = n == 0 ? first : second;
    if (flat[n]) s.circumradius = exact_circumradius(c[0], c[1], c[2], c[3]);
  }
  return shapes;
}

// With z = sum lambda_i p_i the circumcentre, R dR = sum lambda_i (p_i - z) . dp_i, so |dR| <= d sum |lambda_i|.
double circumradius_tolerance(const Corners& p, const TetShape& s, Precision precision) {
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
double dihedral_tolerance_degrees(const Corners& p, Precision precision) {
  double altitude = std::numeric_limits<double>::infinity();
  for (const auto& f : kTetFaces) {
    const TriangleShape face = shape_of(p[f[0]], p[f[1]], p[f[2]]);
    altitude = std::min(altitude, face.double_area / *std::max_element(face.length, face.length + 3));
  }
  return 4 * precision.displacement_mm / altitude * kDegrees;
}

struct TetMeasures {
  explicit TetMeasures(double scale) : ratios(0.6, 2.6, 40), edges(0, 3 * scale, 30) {}
  TetQuality quality;
  CosineSpread dihedrals;
  double largest_cosine = -2;
  Spread ratios, edges;

  void append(const TetMeasures& later) {
    quality.not_positive.append(later.quality.not_positive);
    append_largest(quality.radius_edge, later.quality.radius_edge);
    append_largest(quality.circumradius, later.quality.circumradius);
    append_smallest(quality.dihedral, later.quality.dihedral);
    quality.volume_mm3 += later.quality.volume_mm3;
    dihedrals.append(later.dihedrals);
    ratios.append(later.ratios);
    edges.append(later.edges);
  }
};

void hold_to_bounds(const Corners& p, const TetShape& s, double largest_cosine, const Promises& bounds,
                    Precision precision, TetQuality& result) {
  constexpr double kSlack = 1 + kRelativeTolerance;
  const double ratio = s.circumradius / s.shortest;
  if (bounds.radius_edge && !(ratio <= *bounds.radius_edge * kSlack)) {
    const double move =
        circumradius_tolerance(p, s, precision) / s.shortest + ratio * 2 * precision.displacement_mm / s.shortest;
    if (!(ratio <= *bounds.radius_edge * kSlack + move)) ++result.radius_edge.violations;
  }
  if (bounds.cell_size && !(s.circumradius <= *bounds.cell_size * kSlack)) {
    const double move = circumradius_tolerance(p, s, precision);
    if (!(s.circumradius <= *bounds.cell_size * kSlack + move)) ++result.circumradius.violations;
  }
  if (bounds.min_dihedral_degrees) {
    const double dihedral = degrees_of_cosine(largest_cosine);
    if (!(dihedral * kSlack >= *bounds.min_dihedral_degrees) &&
        !(dihedral * kSlack >= *bounds.min_dihedral_degrees - dihedral_tolerance_degrees(p, precision))) {
      ++result.dihedral.violations;
    }
  }
}

// The volume as computed is off by less than 8 epsilon times six products of three edge components (Shewchuk); what
// this cannot settle goes to the exact predicate.
bool is_positive(const Corners& p, const TetShape& s) {
  constexpr double kRounding = 1e-14, kUnderflowGuard = 1e-250;
  const double error = kRounding * s.longest * s.longest * s.longest;
  if (s.six_volumes > error && error > kUnderflowGuard) return true;
  return orientation(p[0], p[1], p[2], p[3]) > 0;
}

void measure_tet(const Corners& p, TetShape s, const Promises& bounds, Precision precision, const AngleBins& bin_of,
                 TetMeasures& measures) {
  TetQuality& quality = measures.quality;
  const auto where = [&p] { return 0.25 * ((p[0] + p[1]) + (p[2] + p[3])); };
  if (!is_positive(p, s)) quality.not_positive.add(where());
  quality.volume_mm3 += s.six_volumes / 6;
  measures.edges.add(s.shortest);
  measures.edges.add(s.longest);
  // A flat tet has no finite radius and no angles; "positive tets" names it, here it counts as infinitely bad.
  const bool flat = !std::isfinite(s.circumradius) || s.six_volumes == 0;
  if (flat) s.circumradius = std::numeric_limits<double>::infinity();
  double largest_cosine = flat ? 1 : -1;
  for (double cosine : s.cosine) {
    if (!std::isfinite(cosine)) continue;
    largest_cosine = std::max(largest_cosine, cosine);
    measures.dihedrals.add(bin_of, cosine);
  }
  const double ratio = s.circumradius / s.shortest;
  measures.ratios.add(std::isfinite(ratio) ? ratio : std::numeric_limits<double>::max());
  keep_largest(quality.radius_edge, ratio, where);
  keep_largest(quality.circumradius, s.circumradius, where);
  if (largest_cosine > measures.largest_cosine) {
    measures.largest_cosine = largest_cosine;
    keep_smallest(quality.dihedral, degrees_of_cosine(largest_cosine), where);
  }
  hold_to_bounds(p, s, largest_cosine, bounds, precision, quality);
}

// Edge bins need a scale before the edges are known: the mean over a sample is good enough for bins.
template <class Cell>
double typical_edge(const std::vector<Point3>& points, std::span<const Cell> cells) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells.size(); i += 1 + cells.size() / 1000) {
    const Cell& cell = cells[i];
    sum += distance(points[cell[0]], points[cell[1]]) + distance(points[cell[1]], points[cell[2]]);
    count += 2;
  }
  return sum > 0 ? sum / static_cast<double>(count) : 1;
}

struct TriangleMeasures {
  explicit TriangleMeasures(double scale) : edges(0, 3 * scale, 30) {}
  TriangleQuality quality;
  CosineSpread angles;
  Spread edges;

  void append(const TriangleMeasures& later) {
    append_smallest(quality.angle, later.quality.angle);
    append_largest(quality.circumradius, later.quality.circumradius);
    quality.degenerate.append(later.quality.degenerate);
    angles.append(later.angles);
    edges.append(later.edges);
  }
};

void measure_triangle(const std::array<Point3, 3>& p, const Promises& bounds, Precision precision,
                      const AngleBins& bin_of, TriangleMeasures& measures) {
  constexpr double kFlat = 1e-14;  // altitude over longest edge below which double holds no area
  constexpr double kSlack = 1 + kRelativeTolerance;
  TriangleQuality& quality = measures.quality;
  const TriangleShape s = shape_of(p[0], p[1], p[2]);
  const auto where = [&p] { return (1.0 / 3) * (p[0] + p[1] + p[2]); };
  const double longest = *std::max_element(s.length, s.length + 3);
  for (double length : s.length) measures.edges.add(length);
  if (!(s.double_area > longest * std::max(kFlat * longest, precision.displacement_mm))) {
    quality.degenerate.add(where());
    keep_smallest(quality.angle, 0, where);
    if (bounds.min_angle_degrees) ++quality.angle.violations;
    return;
  }
  for (double cosine : s.cosine) measures.angles.add(bin_of, cosine);
  const double angle = degrees_of_cosine(*std::max_element(s.cosine, s.cosine + 3));
  keep_smallest(quality.angle, angle, where);
  keep_largest(quality.circumradius, s.circumradius, where);
  if (bounds.min_angle_degrees &&
      !(angle * kSlack + angle_tolerance_degrees(s, precision) >= *bounds.min_angle_degrees)) {
    ++quality.angle.violations;
  }
  if (bounds.size && !(s.circumradius <= *bounds.size * kSlack + circumradius_tolerance(s, precision))) {
    ++quality.circumradius.violations;
  }
}

// measure(corners of two cells or of a last one, part): in chunks, and puts the chunks together in order.
template <class Measures, class Cell, class MeasurePair>
Measures measure_all(const std::vector<Point3>& points, std::span<const Cell> cells, const MeasurePair& measure) {
  constexpr std::size_t kAhead = 16;  // points lie anywhere: fetched ahead, a quarter of the time is saved
  const double scale = typical_edge(points, cells);
  const auto corners_of = [&](std::size_t i) {
    std::array<Point3, std::tuple_size_v<Cell>> corners;
    for (std::size_t c = 0; c < corners.size(); ++c) corners[c] = points[cells[i][c]];
    return corners;
  };
  const auto parts = map_chunks(cells.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    auto part = std::make_unique<Measures>(scale);
    for (std::size_t i = begin; i < end; i += 2) {
      const std::size_t next = std::min(i + 1, end - 1);
      for (std::size_t ahead : {i + kAhead, next + kAhead}) {
        for (std::uint32_t v : cells[std::min(ahead, end - 1)]) __builtin_prefetch(&points[v]);
      }
      const std::array both{corners_of(i), corners_of(next)};
      measure(std::span(both.data(), next - i + 1), *part);
    }
    return part;
  });
  Measures all(scale);
  for (const auto& part : parts) all.append(*part);
  return all;
}

}  // namespace

Point3 circumcenter(const Point3& a, const Point3& b, const Point3& c) {
  const Vector3 u = b - a, v = c - a, n = cross(u, v);
  const Vector3 offset = squared_norm(u) * cross(v, n) + squared_norm(v) * cross(n, u);
  return a + (1 / (2 * squared_norm(n))) * offset;
}

TriangleQuality measure_triangles(const std::vector<Point3>& points, std::span<const Triangle> triangles,
                                  const Promises& bounds, Precision precision) {
  const AngleBins bin_of;
  using Three = std::array<Point3, 3>;
  const auto all =
      measure_all<TriangleMeasures>(points, triangles, [&](std::span<const Three> cells, TriangleMeasures& measures) {
        for (const Three& corners : cells) measure_triangle(corners, bounds, precision, bin_of, measures);
      });
  TriangleQuality result = all.quality;
  result.angles = all.angles.degrees();
  result.edges = all.edges.distribution();
  return result;
}

TetQuality measure_tets(const std::vector<Point3>& points, std::span<const Tet> tets, const Promises& bounds,
                        Precision precision) {
  const AngleBins bin_of;
  const auto all = measure_all<TetMeasures>(points, tets, [&](std::span<const Corners> cells, TetMeasures& measures) {
    const std::array<TetShape, 2> shapes = shapes_of(cells.front(), cells.back());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      measure_tet(cells[i], shapes[i], bounds, precision, bin_of, measures);
    }
  });
  TetQuality result = all.quality;
  result.dihedrals = all.dihedrals.degrees();
  result.ratios = all.ratios.distribution();
  result.edges = all.edges.distribution();
  return result;
}

}  // namespace delvox::check
