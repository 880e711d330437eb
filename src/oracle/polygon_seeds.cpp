#include "oracle/polygon_seeds.h"

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "oracle/poisson_thinning.h"

namespace delvox {
namespace {

/// A component is spanned by this many spacings at least.
constexpr double kSpacingsPerComponent = 3;
/// Candidates per square of the spacing; more would hardly fill the gaps any better.
constexpr double kCandidatesPerSquare = 6;

class SeedMaker {
 public:
  SeedMaker(const PolygonSurface& surface, const SizeField& size, const GoOn& go_on)
      : surface_(surface), size_(size), go_on_(go_on), extents_(surface.components, 0.0), thinner_(usual_spacing()) {}

  Seeds run() {
    seeds_.components = surface_.components;
    // Vertices before anything else: corners and edges are theirs.
    std::vector<bool> met(surface_.points.size(), false);
    for_each_triangle([&](std::uint32_t t, double extent) {
      for (std::uint32_t v : surface_.triangles[t]) {
        if (!met[v]) add(surface_.points[v], extent);
        met[v] = true;
      }
    });
    for_each_triangle([&](std::uint32_t t, double extent) { add_points_of(t, extent); });
    return std::move(seeds_);
  }

 private:
  double usual_spacing() {
    std::vector<Box3> boxes(surface_.components);
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
      for (int i = 0; i < 3; ++i) boxes[surface_.component_of[t]].extend(surface_.corner(t, i));
    }
    double usual = size_.minimum(), largest = 0;
    for (std::uint32_t c = 0; c < surface_.components; ++c) {
      extents_[c] = boxes[c].diagonal();
      largest = std::max(largest, extents_[c]);
    }
    return std::min(usual, largest / kSpacingsPerComponent);
  }

  template <class Visit>
  void for_each_triangle(const Visit& visit) {
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) {
      if (stopped_ || (stopped_ = !go_on_())) return;
      component_ = surface_.component_of[t];
      visit(t, extents_[component_]);
    }
  }

  double spacing_at(const Point3& p, double extent) const {
    return std::min(size_(p), extent / kSpacingsPerComponent);
  }

  void add(const Point3& p, double extent) {
    if (!thinner_.keep(p, spacing_at(p, extent))) return;
    seeds_.points.push_back(p);
    seeds_.component_of.push_back(component_);
  }

  /// Of a triangle with edges within the spacing no point is far from a vertex.
  void add_points_of(std::uint32_t t, double extent) {
    const Point3 &a = surface_.corner(t, 0), &b = surface_.corner(t, 1), &c = surface_.corner(t, 2);
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    const double least = std::min(size_.minimum(), extent / kSpacingsPerComponent);
    if (longest <= least) return;
    const double spacing = size_.constant() ? least : std::min({spacing_at(a, extent), spacing_at(b, extent),
                                                                spacing_at(c, extent), spacing_at((1.0 / 3) * (a + b + c), extent)});
    const double area = 0.5 * norm(cross(b - a, c - a));
    // Edges first, then the rest: candidates along a needle's edges span it, whatever its area.
    add_points_between(a, b, t, 0, spacing, extent);
    add_points_between(b, c, t, 1, spacing, extent);
    add_points_between(c, a, t, 2, spacing, extent);
    const double wanted = kCandidatesPerSquare * area / (spacing * spacing);
    const std::uint64_t place = mix_hash(t + 1);
    const auto count = static_cast<std::uint64_t>(std::min(wanted + unit_interval(place), 1e15));
    for (std::uint64_t i = 0; i < count && !stopped_; ++i) {
      if (i % 1024 == 1023) stopped_ = !go_on_();
      const std::uint64_t h = mix_hash(place + i);
      double u = unit_interval(h), v = unit_interval(mix_hash(h));
      if (u + v > 1) u = 1 - u, v = 1 - v;
      add((1 - u - v) * a + u * b + v * c, extent);
    }
  }

  /// Shared edges come up twice; thinning refuses the second time.
  void add_points_between(const Point3& a, const Point3& b, std::uint32_t t, std::uint64_t edge, double spacing,
                          double extent) {
    const double steps = std::ceil(2 * distance(a, b) / spacing);
    if (steps < 2 || !(steps < 1e9)) return;
    for (double i = 1; i < steps && !stopped_; ++i) {
      const std::uint64_t h = mix_hash(mix_hash(3 * std::uint64_t{t} + edge) + static_cast<std::uint64_t>(i));
      const double s = (i + 0.5 * (unit_interval(h) - 0.5)) / steps;
      add((1 - s) * a + s * b, extent);
    }
  }

  const PolygonSurface& surface_;
  const SizeField& size_;
  const GoOn& go_on_;
  std::vector<double> extents_;  // of each component: the diagonal of its box
  PoissonThinner thinner_;
  bool stopped_ = false;
  std::uint32_t component_ = 0;  // of the triangle being visited
  Seeds seeds_;
};

}  // namespace

Seeds polygon_seeds(const PolygonSurface& surface, const SizeField& size, const GoOn& go_on) {
  return SeedMaker(surface, size, go_on).run();
}

}  // namespace delvox
