#include "check/tet_topology.h"

#include <algorithm>

#include "check/incidence.h"

namespace delvox::check {
namespace {

Triangle face_of(const Tet& tet, std::uint32_t face) {
  return {tet[kTetFaces[face][0]], tet[kTetFaces[face][1]], tet[kTetFaces[face][2]]};
}

Point3 centroid(const std::vector<Point3>& points, const Triangle& t) {
  return (1.0 / 3) * (points[t[0]] + points[t[1]] + points[t[2]]);
}

// Only called when some face is crowded or folded: two equal tets share all their faces in one of these ways.
void find_duplicate_tets(const TetMesh& mesh, Tally& duplicates) {
  std::vector<Tet> sorted = mesh.tets;
  for (Tet& tet : sorted) std::sort(tet.begin(), tet.end());
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] == sorted[i - 1]) duplicates.add(mesh.points[sorted[i][0]]);
  }
}

}  // namespace

TetTopology tet_topology(const TetMesh& mesh) {
  TetTopology result;
  UnionFind components(mesh.tets.size());
  std::vector<std::uint32_t> single;
  const auto region = [&](std::uint32_t tet) { return mesh.regions.empty() ? Label{1} : mesh.regions[tet]; };
  for_each_shared_simplex(
      mesh.points.size(), 4 * mesh.tets.size(),
      [&](std::size_t item) {
        const Tet& tet = mesh.tets[item / 4];
        const int* face = kTetFaces[item % 4];
        return face_key(tet[face[0]], tet[face[1]], tet[face[2]]);
      },
      [&](std::span<const Incidence> face) {
        const std::uint32_t item = face[0].item();
        if (face.size() == 1) return single.push_back(item);
        const auto where = [&] { return centroid(mesh.points, face_of(mesh.tets[item / 4], item % 4)); };
        if (face.size() > 2) result.crowded_faces.add(where());
        else if (face[0].flipped() == face[1].flipped()) result.folded_faces.add(where());
        for (std::size_t i = 1; i < face.size(); ++i) components.join(item / 4, face[i].item() / 4);
        if (region(item / 4) != region(face[1].item() / 4)) {
          result.interfaces.push_back(face_of(mesh.tets[item / 4], item % 4));
        }
      });
  std::sort(single.begin(), single.end());
  for (std::uint32_t item : single) result.boundary.push_back(face_of(mesh.tets[item / 4], item % 4));
  result.components = components.set_count();
  if (result.crowded_faces.count + result.folded_faces.count > 0) find_duplicate_tets(mesh, result.duplicate_tets);
  return result;
}

Tally boundary_list_faults(const TetMesh& mesh, const TetTopology& topology) {
  const std::size_t faces = topology.boundary.size(), interfaces = topology.interfaces.size();
  const auto triangle = [&](std::size_t i) -> const Triangle& {
    if (i < faces) return topology.boundary[i];
    if (i < faces + interfaces) return topology.interfaces[i - faces];
    return mesh.boundary[i - faces - interfaces];
  };
  Tally faults;
  for_each_shared_simplex(
      mesh.points.size(), faces + interfaces + mesh.boundary.size(),
      [&](std::size_t i) { return face_key(triangle(i)[0], triangle(i)[1], triangle(i)[2]); },
      [&](std::span<const Incidence> same) {
        const std::uint32_t first = same[0].item();
        const bool is_boundary = first < faces, is_interface = !is_boundary && first < faces + interfaces;
        const bool listed_once = same.size() == 2 && same[1].item() >= faces + interfaces;
        const bool fine = is_boundary    ? listed_once && same[0].flipped() == same[1].flipped()
                          : is_interface ? same.size() <= 3  // listed once, or from both sides, or not at all
                                         : false;
        if (!fine) faults.add(centroid(mesh.points, triangle(first)));
      });
  return faults;
}

}  // namespace delvox::check
