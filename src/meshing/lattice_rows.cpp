#include "meshing/lattice_rows.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/round.h"
#include "delaunay/restricted_triangles.h"

namespace delvox {
namespace {

/// Twice the signed area of (a, b, p) in the plane of y and z; exactly opposite for (b, a, p).
double area_beside(const RestrictedDelaunay& delaunay, VertexId a, VertexId b, double y, double z) {
  if (a > b) return -area_beside(delaunay, b, a, y, z);
  const Point3 &p = delaunay.point(a), &q = delaunay.point(b);
  return (q.y - p.y) * (z - p.z) - (q.z - p.z) * (y - p.y);
}

class RowCaster {
 public:
  RowCaster(const RestrictedDelaunay& delaunay, const LatticeRows& rows) : delaunay_(delaunay), rows_(rows) {}

  RowCrossings run() const {
    constexpr std::size_t kChunk = 1 << 12, kAhead = 8;
    const auto cast = [&](std::size_t begin, std::size_t end, std::vector<Hit>& hits) {
      std::vector<FacetId> facets;
      for_each_triangle_with_ball(delaunay_, begin, end, [&](FacetId facet) { facets.push_back(facet); });
      for (std::size_t i = 0; i < facets.size(); ++i) {
        if (i + kAhead < facets.size()) {
          for (VertexId v : delaunay_.vertices(facets[i + kAhead])) delaunay_.prefetch_vertex(v);
        }
        cast_at(facets[i], hits);
      }
    };
    return sorted(gather_chunks<Hit>(delaunay_.cell_capacity(), kChunk, cast));
  }

 private:
  struct Hit {
    std::uint32_t row;
    RowCrossing crossing;
  };

  std::int32_t first_at(double lowest, double origin, double shift) const {
    return std::max(0, static_cast<std::int32_t>(ceil_to_int((lowest - origin) / rows_.step - shift)));
  }

  void cast_at(FacetId facet, std::vector<Hit>& hits) const {
    const auto v = delaunay_.vertices(facet);
    Box3 box;
    for (VertexId vertex : v) box.extend(delaunay_.point(vertex));
    for (const bool centre : {false, true}) {
      const double shift = centre ? 0.5 : 0.0;
      const std::int32_t first_j = first_at(box.min.y, rows_.origin.y, shift);
      for (std::int32_t k = first_at(box.min.z, rows_.origin.z, shift); k < rows_.nz; ++k) {
        const double z = rows_.origin.z + (k + shift) * rows_.step;
        if (z > box.max.z) break;
        for (std::int32_t j = first_j; j < rows_.ny; ++j) {
          const double y = rows_.origin.y + (j + shift) * rows_.step;
          if (y > box.max.y) break;
          const std::int32_t layer = centre ? rows_.nz + k : k;
          hit(facet, v, static_cast<std::uint32_t>(layer) * rows_.ny + j, y, z, hits);
        }
      }
    }
  }

  void hit(FacetId facet, const std::array<VertexId, 3>& v, std::uint32_t row, double y, double z,
           std::vector<Hit>& hits) const {
    std::array<double, 3> weight;  // of each vertex, up to scale
    int left = 0;
    for (int i = 0; i < 3; ++i) {
      const VertexId a = v[(i + 1) % 3], b = v[(i + 2) % 3];
      weight[i] = area_beside(delaunay_, a, b, y, z);
      // On an edge itself the row counts as left of it seen from the lower vertex: of two triangles one sees it so.
      left += weight[i] != 0 ? weight[i] > 0 : a < b;
    }
    if (left != 0 && left != 3) return;
    const double sum = weight[0] + weight[1] + weight[2];
    if (sum == 0) return;
    double x = 0;
    for (int i = 0; i < 3; ++i) x += weight[i] / sum * delaunay_.point(v[i]).x;
    // Seen from outside the facet's cell the corners turn left: with left == 3 the cell lies before the crossing.
    const CellId beyond = left == 3 ? delaunay_.neighbors(facet.cell)[facet.index] : facet.cell;
    hits.push_back({row, {x, delaunay_.label(beyond)}});
  }

  RowCrossings sorted(const std::vector<Hit>& hits) const {
    RowCrossings result;
    result.first.assign(2 * static_cast<std::size_t>(rows_.ny) * rows_.nz + 1, 0);
    for (const Hit& hit : hits) ++result.first[hit.row + 1];
    for (std::size_t row = 1; row < result.first.size(); ++row) result.first[row] += result.first[row - 1];
    result.crossings.resize(hits.size());
    std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
    for (const Hit& hit : hits) result.crossings[next[hit.row]++] = hit.crossing;
    for (std::size_t row = 0; row + 1 < result.first.size(); ++row) {
      std::sort(result.crossings.begin() + result.first[row], result.crossings.begin() + result.first[row + 1],
                [](const RowCrossing& a, const RowCrossing& b) { return a.x != b.x ? a.x < b.x : a.label < b.label; });
    }
    return result;
  }

  const RestrictedDelaunay& delaunay_;
  const LatticeRows& rows_;
};

}  // namespace

RowCrossings find_row_crossings(const RestrictedDelaunay& delaunay, const LatticeRows& rows) {
  return RowCaster(delaunay, rows).run();
}

}  // namespace delvox
