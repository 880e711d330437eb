#include "meshing/extract.h"

namespace delvox {
namespace {

/// Gives vertices output numbers in the order of their first use.
class Numbering {
 public:
  Numbering(const RestrictedDelaunay& delaunay, std::vector<Point3>& points)
      : delaunay_(delaunay), points_(points), numbers_(delaunay.vertex_capacity(), kNone) {}

  std::uint32_t operator()(VertexId vertex) {
    std::uint32_t& number = numbers_[vertex];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(points_.size());
      points_.push_back(delaunay_.point(vertex));
    }
    return number;
  }

 private:
  const RestrictedDelaunay& delaunay_;
  std::vector<Point3>& points_;
  std::vector<std::uint32_t> numbers_;
};

template <class Visit>
void for_each_inside_cell(const RestrictedDelaunay& delaunay, const Visit& visit) {
  for (CellId cell = 0; cell < delaunay.cell_capacity(); ++cell) {
    if (delaunay.stamp(cell) != 0 && delaunay.label(cell) != 0) visit(cell);
  }
}

/// Triangles of `cell` that face the outside.
void add_boundary(const RestrictedDelaunay& delaunay, CellId cell, Numbering& number, std::vector<Triangle>& out) {
  for (int i = 0; i < 4; ++i) {
    if (delaunay.label(delaunay.neighbors(cell)[i]) != 0) continue;
    const auto v = delaunay.vertices(FacetId{cell, i});
    out.push_back({number(v[0]), number(v[1]), number(v[2])});
  }
}

void add_deep(const DeepLattice& deep, Numbering& number, TetMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), deep.points.begin(), deep.points.end());
  const auto shell = static_cast<std::uint32_t>(deep.shell.size());
  for (const auto& corners : deep.tets) {
    Tet tet;
    Label label = 0;
    for (int i = 0; i < 4; ++i) {
      const bool is_deep = corners[i] >= shell;
      tet[i] = is_deep ? first + corners[i] - shell : number(deep.shell[corners[i]]);
      if (is_deep) label = deep.labels[corners[i] - shell];
    }
    mesh.tets.push_back(tet);
    mesh.regions.push_back(label);
  }
}

}  // namespace

SurfaceMesh extract_surface(const RestrictedDelaunay& delaunay) {
  SurfaceMesh mesh;
  Numbering number(delaunay, mesh.points);
  for_each_inside_cell(delaunay, [&](CellId cell) { add_boundary(delaunay, cell, number, mesh.triangles); });
  return mesh;
}

TetMesh extract_tets(const RestrictedDelaunay& delaunay, const DeepLattice* deep) {
  TetMesh mesh;
  Numbering number(delaunay, mesh.points);
  for_each_inside_cell(delaunay, [&](CellId cell) {
    if (delaunay.placeholder(cell)) return;
    const auto& v = delaunay.vertices(cell);
    mesh.tets.push_back({number(v[0]), number(v[1]), number(v[2]), number(v[3])});
    mesh.regions.push_back(delaunay.label(cell));
    add_boundary(delaunay, cell, number, mesh.boundary);
  });
  if (deep != nullptr) add_deep(*deep, number, mesh);
  mesh.on_surface.assign(mesh.points.size(), 0);
  for (const Triangle& triangle : mesh.boundary) {
    for (std::uint32_t vertex : triangle) mesh.on_surface[vertex] = 1;
  }
  return mesh;
}

}  // namespace delvox
