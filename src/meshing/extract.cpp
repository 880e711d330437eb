#include "meshing/extract.h"

#include <atomic>

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

std::vector<CellId> inside_cells(const RestrictedDelaunay& delaunay) {
  return gather_chunks<CellId>(delaunay.cell_capacity(), kChunk, [&](std::size_t begin, std::size_t end, auto& cells) {
    for (auto cell = static_cast<CellId>(begin); cell < end; ++cell) {
      const bool inside = delaunay.stamp(cell) != 0 && delaunay.label(cell) != 0;
      if (inside && !delaunay.placeholder(cell)) cells.push_back(cell);
    }
  });
}

/// As triangles or tets, by output numbers.
template <std::size_t N, class Simplex>
std::vector<std::array<std::uint32_t, N>> numbered(const RestrictedDelaunay& delaunay, const Numbering& number,
                                                   const std::vector<Simplex>& simplices) {
  std::vector<std::array<std::uint32_t, N>> result(simplices.size());
  for_each_chunk(simplices.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = delaunay.vertices(simplices[i]);
      for (std::size_t corner = 0; corner < N; ++corner) result[i][corner] = number(v[corner]);
    }
  });
  return result;
}

/// The vertices at deep tets. Others of the shell may be gone by now.
void use_shell(const DeepLattice& deep, Numbering& number) {
  for_each_chunk(deep.tets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::uint32_t corner : deep.tets[t]) {
        if (deep.vertex(corner) != kNone) number.use(deep.vertex(corner));
      }
    }
  });
}

void add_deep(const DeepLattice& deep, const Numbering& number, TetMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  const std::size_t first_tet = mesh.tets.size();
  const auto shell = static_cast<std::uint32_t>(deep.shell.size());
  mesh.points.insert(mesh.points.end(), deep.points.begin(), deep.points.end());
  mesh.tets.resize(first_tet + deep.tets.size());
  mesh.regions.resize(mesh.tets.size());
  for_each_chunk(deep.tets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t corner = deep.tets[t][i];
        const bool is_deep = corner >= shell;
        mesh.tets[first_tet + t][i] = is_deep ? first + corner - shell : number(deep.shell[corner]);
        if (is_deep) mesh.regions[first_tet + t] = deep.labels[corner - shell];
      }
    }
  });
}

}  // namespace

SurfaceMesh extract_surface(const RestrictedDelaunay& delaunay) {
  SurfaceMesh mesh;
  Numbering number(delaunay);
  const std::vector<FacetId> triangles = outer_triangles(delaunay);
  for (FacetId facet : triangles) {
    for (VertexId v : delaunay.vertices(facet)) number.use(v);
  }
  mesh.points = number.count();
  mesh.triangles = numbered<3>(delaunay, number, triangles);
  return mesh;
}

TetMesh extract_tets(const RestrictedDelaunay& delaunay, const DeepLattice* deep) {
  TetMesh mesh;
  Numbering number(delaunay);
  const std::vector<CellId> cells = inside_cells(delaunay);
  mesh.regions.resize(cells.size());
  for_each_chunk(cells.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      mesh.regions[i] = delaunay.label(cells[i]);
      for (VertexId v : delaunay.vertices(cells[i])) number.use(v);
    }
  });
  if (deep != nullptr) use_shell(*deep, number);
  mesh.points = number.count();
  mesh.tets = numbered<4>(delaunay, number, cells);
  if (deep != nullptr) add_deep(*deep, number, mesh);
  mesh.boundary = numbered<3>(delaunay, number, outer_triangles(delaunay));
  mesh.on_surface.assign(mesh.points.size(), 0);
  for (const Triangle& triangle : mesh.boundary) {
    for (std::uint32_t vertex : triangle) mesh.on_surface[vertex] = 1;
  }
  return mesh;
}

}  // namespace delvox
