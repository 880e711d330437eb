#include "meshing/lattice_rows.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/round.h"

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

  RowCrossings run(const std::vector<FacetId>& triangles) const {
    constexpr std::size_t kChunk = 4096;
    return sorted(gather_chunks<Hit>(triangles.size(), kChunk, [&](std::size_t begin, std::size_t end, auto& hits) {
      for (std::size_t i = begin; i < end; ++i) cast_at(triangles[i], hits);
    }));
  }

 private:
  struct Hit {
    std::uint32_t row;
    RowCrossing crossing;
  };

  std::int32_t first_at(double lowest, double origin) const {
    return static_cast<std::int32_t>(ceil_to_int((lowest - origin) / rows_.step - rows_.shift));
  }

  void cast_at(FacetId facet, std::vector<Hit>& hits) const {
    const auto v = delaunay_.vertices(facet);
    Box3 box;
    for (VertexId vertex : v) box.extend(delaunay_.point(vertex));
    for (std::int32_t k = std::max(0, first_at(box.min.z, rows_.origin.z)); k < rows_.nz; ++k) {
      const double z = rows_.origin.z + (k + rows_.shift) * rows_.step;
      if (z > box.max.z) break;
      for (std::int32_t j = std::max(0, first_at(box.min.y, rows_.origin.y)); j < rows_.ny; ++j) {
        const double y = rows_.origin.y + (j + rows_.shift) * rows_.step;
        if (y > box.max.y) break;
        hit(facet, v, static_cast<std::uint32_t>(k) * rows_.ny + j, y, z, hits);
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
    result.first.assign(static_cast<std::size_t>(rows_.ny) * rows_.nz + 1, 0);
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

RowCrossings find_row_crossings(const RestrictedDelaunay& delaunay, const std::vector<FacetId>& triangles,
                                const LatticeRows& rows) {
  return RowCaster(delaunay, rows).run(triangles);
}

}  // namespace delvox
