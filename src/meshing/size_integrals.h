#pragma once

#include "delvox/meshing/criteria.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// A domain measured in units of the sizes that a mesh of it is asked for. Numbers of elements go with these.
struct SizeIntegrals {
  double surface = 0;  ///< of dA / size^2
  double graded = 0;   ///< of (1 - size / cell size) dA / size^2 where cells may be larger than surface balls
  double volume = 0;   ///< of dV / cell size^3
  double deep = 0;     ///< the part of `volume` that lies farther from the surface than some cell sizes
};

/// The same twice, and how finely the domain is sampled.
struct MeasuredDomain {
  SizeIntegrals wanted;    ///< with the sizes as they are
  SizeIntegrals resolved;  ///< with the thickness of the domain as the size where that is less
  double samples = 0;      ///< of dA / voxel^2
};

/// All zero if the oracle knows no patches. Where the cell size is less than the size, it counts as the size.
/// `tets` may be null: none, as for surfaces.
MeasuredDomain measure_domain(const Oracle& oracle, const SizeField& size, const TetCriteria* tets);

}  // namespace delvox
