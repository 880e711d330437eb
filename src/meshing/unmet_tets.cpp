#include "meshing/unmet_tets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshing/tet_geometry.h"

namespace delvox {
namespace {

TetGeometry geometry_of(const RepairMesh& mesh, const Tet& t) {
  return tet_geometry(mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2]), mesh.point(t[3]));
}

double degrees(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

// Sum of the dihedral angles at edge ab.
double angle_around(const RepairMesh& mesh, std::uint32_t a, std::uint32_t b) {
  double sum = 0;
  for (std::uint32_t t : mesh.star(a)) {
    const Tet& tet = mesh.tet(t);
    if (std::find(tet.begin(), tet.end(), b) == tet.end()) continue;
    int faces[2], found = 0;  // opposite the other two corners: those that meet in ab
    for (int i = 0; i < 4; ++i) {
      if (tet[i] != a && tet[i] != b) faces[found++] = i;
    }
    sum += degrees(geometry_of(mesh, tet).cosine(faces[0], faces[1]));
  }
  return sum;
}

bool folds_at_an_edge(const RepairMesh& mesh, const Tet& tet, double bound) {
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (mesh.has_boundary_edge(tet[i], tet[j]) && angle_around(mesh, tet[i], tet[j]) < bound) return true;
    }
  }
  return false;
}

int faces_on_boundary(const RepairMesh& mesh, const Tet& tet) {
  return static_cast<int>(std::count_if(std::begin(kTetFaces), std::end(kTetFaces), [&](const auto& f) {
    return mesh.boundary_triangle(tet[f[0]], tet[f[1]], tet[f[2]]) != RepairMesh::kNone;
  }));
}

// Why no tets that keep the nodes and triangles there could do better; none if they might.
const char* what_forbids(const RepairMesh& mesh, const Tet& tet, double min_dihedral_degrees) {
  if (faces_on_boundary(mesh, tet) >= 3) return "three or four of the tet's faces lie on the surface";
  if (folds_at_an_edge(mesh, tet, min_dihedral_degrees)) return "the surface folds more sharply at an edge of the tet";
  return nullptr;
}

}  // namespace

bool surface_forbids(const RepairMesh& mesh, const Tet& tet, double min_dihedral_degrees) {
  return what_forbids(mesh, tet, min_dihedral_degrees) != nullptr;
}

std::vector<UnmetTet> unmet_tets(const RepairMesh& mesh, std::span<const std::uint32_t> slivers,
                                 double min_dihedral_degrees) {
  std::vector<UnmetTet> result;
  for (std::uint32_t t : slivers) {
    const Tet& tet = mesh.tet(t);
    UnmetTet unmet;
    unmet.where = 0.25 * ((mesh.point(tet[0]) + mesh.point(tet[1])) + (mesh.point(tet[2]) + mesh.point(tet[3])));
    unmet.dihedral_degrees = degrees(geometry_of(mesh, tet).largest_cosine());
    if (unmet.dihedral_degrees >= min_dihedral_degrees) continue;  // repair aims a little higher
    const char* forbids = what_forbids(mesh, tet, min_dihedral_degrees);
    unmet.surface_forbids = forbids != nullptr;
    unmet.reason = forbids ? forbids : "no change was found that keeps all other bounds";
    result.push_back(std::move(unmet));
  }
  return result;
}

}  // namespace delvox
