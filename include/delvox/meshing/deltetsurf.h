#pragma once

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"
#include "delvox/meshing/variant.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What deltetsurf is asked for.
struct DelTetSurfOptions {
  SurfaceCriteria surface;
  TetCriteria tets;
  RunControl control;
  Variant variant = {};
};

/// DelTetSurf (book, 14.5), in its isosurface variant or on Del|Sigma as a whole: tetrahedra of the inside, whose
/// boundary is a closed 2-manifold with vertices on the oracle's surface. A limit or an unmet criterion is told in the
/// report, and the mesh is what there was. Throws OptionError, NothingToMesh, Cancelled.
TetMesh deltetsurf(const Oracle& oracle, const DelTetSurfOptions& options, RunReport& report);

}  // namespace delvox
