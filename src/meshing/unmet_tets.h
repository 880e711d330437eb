#pragma once

#include <span>
#include <vector>

#include "delvox/meshing/remove_slivers.h"
#include "meshing/repair_mesh.h"

namespace delvox {

/// The criterion that unmet dihedral angles are told under.
inline constexpr const char* kDihedral = "dihedral";

/// Whether no tets that keep the nodes and triangles at a tet could do better: the surface folds at one of its edges
/// more sharply than the bound, or three of its faces lie on the surface.
bool surface_forbids(const RepairMesh& mesh, const Tet& tet, double min_dihedral_degrees);

/// Those tets that have a smaller dihedral angle: where they lie, and why they are: the surface forbids more,
/// or no change was found.
std::vector<UnmetTet> unmet_tets(const RepairMesh& mesh, std::span<const std::uint32_t> slivers,
                                 double min_dihedral_degrees);

}  // namespace delvox
