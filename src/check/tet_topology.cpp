#include "check/tet_topology.h"

#include <tbb/parallel_sort.h>

#include <algorithm>

#include "check/incidence.h"
#include "core/union_find.h"

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
  struct Found {
    Tally crowded, folded;
    std::vector<std::uint32_t> single;
    std::vector<Triangle> interfaces;
  };
  UnionFind components(mesh.tets.size());
  const auto region = [&](std::uint32_t tet) { return mesh.regions.empty() ? Label{1} : mesh.regions[tet]; };
  const auto parts = map_shared_simplices<Found, 4>(
      mesh.points.size(), std::span<const Tet>(mesh.tets),
      [](const Tet& tet, int i) { return face_key(tet[kTetFaces[i][0]], tet[kTetFaces[i][1]], tet[kTetFaces[i][2]]); },
      [&](std::span<const Incidence> face, Found& found) {
        const std::uint32_t item = face[0].item();
        if (face.size() == 1) return found.single.push_back(item);
        const auto where = [&] { return centroid(mesh.points, face_of(mesh.tets[item / 4], item % 4)); };
        if (face.size() > 2)
          found.crowded.add(where());
        else if (face[0].flipped() == face[1].flipped())
          found.folded.add(where());
        for (std::size_t i = 1; i < face.size(); ++i) components.join(item / 4, face[i].item() / 4);
        if (region(item / 4) != region(face[1].item() / 4)) {
          found.interfaces.push_back(face_of(mesh.tets[item / 4], item % 4));
        }
      },
      [&](std::uint32_t item) { components.prefetch(item / 4); });
  TetTopology result;
  std::vector<std::uint32_t> single;
  for (const Found& found : parts) {
    result.crowded_faces.append(found.crowded);
    result.folded_faces.append(found.folded);
    single.insert(single.end(), found.single.begin(), found.single.end());
    result.interfaces.insert(result.interfaces.end(), found.interfaces.begin(), found.interfaces.end());
  }
  tbb::parallel_sort(single);
  result.boundary.reserve(single.size());
  for (std::uint32_t item : single) result.boundary.push_back(face_of(mesh.tets[item / 4], item % 4));
  result.components = components.set_count();
  if (result.crowded_faces.count + result.folded_faces.count > 0) find_duplicate_tets(mesh, result.duplicate_tets);
  return result;
}

Tally boundary_list_faults(const TetMesh& mesh, const TetTopology& topology) {
  const std::size_t faces = topology.boundary.size(), interfaces = topology.interfaces.size();
  std::vector<Triangle> triangles = topology.boundary;
  triangles.insert(triangles.end(), topology.interfaces.begin(), topology.interfaces.end());
  triangles.insert(triangles.end(), mesh.boundary.begin(), mesh.boundary.end());
  return sum_of(map_shared_simplices<Tally, 1>(
      mesh.points.size(), std::span<const Triangle>(triangles), triangle_key,
      [&](std::span<const Incidence> same, Tally& faults) {
        const std::uint32_t first = same[0].item();
        const bool is_boundary = first < faces, is_interface = !is_boundary && first < faces + interfaces;
        const bool listed_once = same.size() == 2 && same[1].item() >= faces + interfaces;
        const bool fine = is_boundary    ? listed_once && same[0].flipped() == same[1].flipped()
                          : is_interface ? same.size() <= 3  // listed once, or from both sides, or not at all
                                         : false;
        if (!fine) faults.add(centroid(mesh.points, triangles[first]));
      }));
}

}  // namespace delvox::check
