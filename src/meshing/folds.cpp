#include "meshing/folds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include "core/parallel.h"

namespace delvox {
namespace {

class WedgeSearch {
 public:
  WedgeSearch(const RestrictedDelaunay& delaunay, double min_degrees)
      : delaunay_(delaunay), bound_(min_degrees * std::numbers::pi / 180), cosine_(std::cos(bound_)) {}

  /// The triangle on the other side of the wedge at the edge opposite a corner of `facet`, if the wedge is too sharp.
  /// pre: facet is restricted, of a cell of the domain.
  std::optional<FacetId> across(FacetId facet, int corner) const;

 private:
  Vector3 outward(FacetId facet) const {
    const auto v = delaunay_.vertices(facet);
    const Point3& p = delaunay_.point(v[0]);
    return cross(delaunay_.point(v[1]) - p, delaunay_.point(v[2]) - p);
  }

  const RestrictedDelaunay& delaunay_;
  const double bound_, cosine_;
};

/// From cell to cell around the edge, through the domain.
std::optional<FacetId> WedgeSearch::across(FacetId facet, int corner) const {
  VertexId apex = delaunay_.vertices(facet)[static_cast<std::size_t>(corner)];  // of the facet, beside the edge
  double angle = 0;
  while (true) {
    const auto& v = delaunay_.vertices(facet.cell);
    const FacetId wall{facet.cell, static_cast<int>(std::find(v.begin(), v.end(), apex) - v.begin())};
    const Vector3 m = outward(facet), n = outward(wall);
    const double cosine = -dot(m, n) / std::sqrt(squared_norm(m) * squared_norm(n));
    if (!(cosine > cosine_)) return std::nullopt;
    angle += std::acos(std::min(1.0, cosine));
    if (!(angle < bound_)) return std::nullopt;
    if (delaunay_.bipolar(wall)) return wall;
    apex = v[facet.index];
    facet = delaunay_.mirror(wall);
  }
}

}  // namespace

std::vector<Fold> sharp_folds(const RestrictedDelaunay& delaunay, double min_degrees, std::uint32_t new_from) {
  constexpr std::size_t kChunk = 1 << 14;
  const WedgeSearch search(delaunay, min_degrees);
  const auto is_new = [&](FacetId facet) {
    return delaunay.stamp(facet.cell) >= new_from ||
           delaunay.stamp(delaunay.neighbors(facet.cell)[facet.index]) >= new_from;
  };
  const auto collect = [&](FacetId facet, std::vector<Fold>& found) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto other = search.across(facet, corner);
      if (!other) continue;
      const bool met_from_there = is_new(*other) && std::tie(other->cell, other->index) < std::tie(facet.cell, facet.index);
      if (met_from_there) continue;
      found.push_back({{Fold::Side{facet, delaunay.stamp(facet.cell)}, Fold::Side{*other, delaunay.stamp(other->cell)}}});
    }
  };
  return gather_chunks<Fold>(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, auto& found) {
    for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
      if (delaunay.stamp(cell) == 0 || delaunay.label(cell) == 0) continue;
      for (int i = 0; i < 4; ++i) {
        const FacetId facet{cell, i};
        if (delaunay.bipolar(facet) && is_new(facet)) collect(facet, found);
      }
    }
  });
}

}  // namespace delvox
