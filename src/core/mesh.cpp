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

Triangle face_corners(const std::vector<Tet>& tets, TetFace face) {
  const Tet& tet = tets[face.tet];
  const auto& corners = kTetFaces[face.face];
  return {tet[corners[0]], tet[corners[1]], tet[corners[2]]};
}

std::array<std::uint32_t, 3> face_mid_nodes(const MidNodes& of_tet, int face) {
  std::array<std::uint32_t, 3> result{};
  for (int i = 0; i < 3; ++i) {
    const int a = kTetFaces[face][i], b = kTetFaces[face][(i + 1) % 3];
    for (int e = 0; e < 6; ++e) {
      const auto& edge = kTetEdges[e];
      if ((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a)) result[i] = of_tet[e];
    }
  }
  return result;
}

std::vector<TetFace> boundary_faces(const std::vector<Tet>& tets) {
  std::vector<Face> faces;
  faces.reserve(4 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) faces.push_back(make_face(tets[t], t, i));
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
  std::vector<TetFace> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].sorted == faces[i].sorted) ++end;
    if (end == i + 1) single.push_back({faces[i].tet, faces[i].index});
    i = end;
  }
  std::sort(single.begin(), single.end());
  return single;
}

std::vector<Triangle> boundary_of(const std::vector<Tet>& tets) {
  std::vector<Triangle> result;
  for (TetFace face : boundary_faces(tets)) result.push_back(face_corners(tets, face));
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
