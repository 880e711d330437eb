#include "delvox/core/mesh.h"

#include <algorithm>
#include <limits>

namespace delvox {
namespace {

struct Face {
  std::array<std::uint32_t, 3> sorted;
  std::uint32_t tet;
  std::uint8_t index;
};

Face make_face(const Tet& tet, std::uint32_t tet_index, int face) {
  Face f{{tet[kTetFaces[face][0]], tet[kTetFaces[face][1]], tet[kTetFaces[face][2]]},
         tet_index, static_cast<std::uint8_t>(face)};
  std::sort(f.sorted.begin(), f.sorted.end());
  return f;
}

}  // namespace

std::vector<Triangle> boundary_of(const std::vector<Tet>& tets) {
  std::vector<Face> faces;
  faces.reserve(4 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) faces.push_back(make_face(tets[t], t, i));
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
  std::vector<Face> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) ++end;
    if (end == i + 1) single.push_back(faces[i]);
    i = end;
  }
  std::sort(single.begin(), single.end(),
            [](const Face& a, const Face& b) { return a.tet != b.tet ? a.tet < b.tet : a.index < b.index; });
  std::vector<Triangle> result;
  result.reserve(single.size());
  for (const Face& f : single) {
    const Tet& tet = tets[f.tet];
    result.push_back({tet[kTetFaces[f.index][0]], tet[kTetFaces[f.index][1]], tet[kTetFaces[f.index][2]]});
  }
  return result;
}

SurfaceMesh boundary_surface(const TetMesh& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  SurfaceMesh surface;
  surface.info = mesh.info;
  std::vector<std::uint32_t> renumbered(mesh.points.size(), kUnused);
  const std::vector<Triangle> faces = mesh.boundary.empty() ? boundary_of(mesh.tets) : mesh.boundary;
  surface.triangles.reserve(faces.size());
  for (const Triangle& face : faces) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t& index = renumbered[face[i]];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(surface.points.size());
        surface.points.push_back(mesh.points[face[i]]);
      }
      triangle[i] = index;
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

}  // namespace delvox
