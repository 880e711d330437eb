#pragma once

#include <span>
#include <vector>

#include "delvox/meshing/remove_slivers.h"
#include "meshing/repair_mesh.h"

namespace delvox {

/// The criterion that unmet dihedral angles are told under.
inline constexpr const char* kDihedral = "dihedral";

/// Those tets that have a smaller dihedral angle: where they lie, and why they are: the surface folds at one of their
/// edges more sharply than the bound, so that whatever tets lie in the fold have such an angle; three of their faces
/// lie on the surface, whose edges are those of the tet alone; or no change was found.
std::vector<UnmetTet> unmet_tets(const RepairMesh& mesh, std::span<const std::uint32_t> slivers,
                                 double min_dihedral_degrees);

}  // namespace delvox
