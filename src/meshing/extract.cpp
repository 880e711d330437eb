#include "meshing/extract.h"

#include <atomic>
#include <numeric>

#include "core/parallel.h"
#include "delaunay/restricted_triangles.h"

namespace delvox {
namespace {

constexpr std::size_t kChunk = 1 << 14;

/// Output numbers for the vertices that are used, in the order of the vertices.
class Numbering {
 public:
  explicit Numbering(const RestrictedDelaunay& delaunay)
      : delaunay_(delaunay), used_(delaunay.vertex_capacity(), 0), numbers_(delaunay.vertex_capacity(), kNone) {}

  /// Beside other calls: whoever uses a vertex writes the same.
  void use(VertexId vertex) { std::atomic_ref(used_[vertex]).store(1, std::memory_order_relaxed); }
  /// Once all are known: their points.
  std::vector<Point3> count() {
    std::vector<Point3> points;
    points.reserve(delaunay_.vertex_count());
    for (VertexId v = 0; v < used_.size(); ++v) {
      if (used_[v] == 0) continue;
      numbers_[v] = static_cast<std::uint32_t>(points.size());
      points.push_back(delaunay_.point(v));
    }
    return points;
  }
  std::uint32_t operator()(VertexId vertex) const { return numbers_[vertex]; }

 private:
  const RestrictedDelaunay& delaunay_;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> numbers_;
};

/// Restricted triangles that face the outside.
std::vector<FacetId> outer_triangles(const RestrictedDelaunay& delaunay) {
  std::vector<FacetId> triangles = restricted_triangles(delaunay);
  std::erase_if(triangles,
                [&](FacetId facet) { return delaunay.label(delaunay.neighbors(facet.cell)[facet.index]) != 0; });
  return triangles;
}

/// visit(cell) for the chunk's cells inside the domain.
template <class Visit>
void for_each_inside(const RestrictedDelaunay& delaunay, std::size_t begin, std::size_t end, const Visit& visit) {
  for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
    if (delaunay.stamp(cell) != 0 && delaunay.label(cell) != 0) visit(cell);
  }
}

/// Uses the vertices of the cells inside; where each chunk's cells begin among all, and their number at the end.
std::vector<std::size_t> use_inside(const RestrictedDelaunay& delaunay, Numbering& number) {
  const auto counts = map_chunks(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for_each_inside(delaunay, begin, end, [&](CellId cell) {
      ++count;
      for (VertexId v : delaunay.vertices(cell)) number.use(v);
    });
    return count;
  });
  std::vector<std::size_t> first(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), first.begin() + 1);
  return first;
}

template <class Simplex>
auto numbered(const RestrictedDelaunay& delaunay, const Numbering& number, Simplex simplex) {
  auto corners = delaunay.vertices(simplex);
  for (auto& corner : corners) corner = number(corner);
  return corners;
}

std::vector<Triangle> numbered_triangles(const RestrictedDelaunay& delaunay, const Numbering& number,
                                         const std::vector<FacetId>& facets) {
  std::vector<Triangle> triangles(facets.size());
  for_each_chunk(facets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) triangles[i] = numbered(delaunay, number, facets[i]);
  });
  return triangles;
}

std::vector<Edge> numbered_edges(const Numbering& number, const std::vector<std::array<VertexId, 2>>& edges) {
  std::vector<Edge> result;
  for (const auto& [a, b] : edges) result.push_back({number(a), number(b)});
  return result;
}

void add_inside(const RestrictedDelaunay& delaunay, const Numbering& number, const std::vector<std::size_t>& first,
                TetMesh& mesh) {
  for_each_chunk(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::size_t next = first[begin / kChunk];
    for_each_inside(delaunay, begin, end, [&](CellId cell) {
      mesh.tets[next] = numbered(delaunay, number, cell);
      mesh.regions[next++] = delaunay.label(cell);
    });
  });
}

}  // namespace

SurfaceMesh extract_surface(const RestrictedDelaunay& delaunay, const std::vector<std::array<VertexId, 2>>& features) {
  SurfaceMesh mesh;
  Numbering number(delaunay);
  const std::vector<FacetId> triangles = outer_triangles(delaunay);
  for (FacetId facet : triangles) {
    for (VertexId v : delaunay.vertices(facet)) number.use(v);
  }
  mesh.points = number.count();
  mesh.triangles = numbered_triangles(delaunay, number, triangles);
  mesh.features = numbered_edges(number, features);
  return mesh;
}

TetMesh extract_tets(const RestrictedDelaunay& delaunay, const std::vector<std::array<VertexId, 2>>& features) {
  TetMesh mesh;
  Numbering number(delaunay);
  const std::vector<std::size_t> first = use_inside(delaunay, number);
  mesh.points = number.count();
  mesh.tets.resize(first.back());
  mesh.regions.resize(mesh.tets.size());
  add_inside(delaunay, number, first, mesh);
  mesh.boundary = numbered_triangles(delaunay, number, outer_triangles(delaunay));
  mesh.features = numbered_edges(number, features);
  mesh.on_surface.assign(mesh.points.size(), 0);
  for (const Triangle& triangle : mesh.boundary) {
    for (std::uint32_t vertex : triangle) mesh.on_surface[vertex] = 1;
  }
  return mesh;
}

}  // namespace delvox
