#pragma once

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What delsurf is asked for.
struct DelSurfOptions {
  SurfaceCriteria surface;
  RunControl control;
};

/// DelSurf (book, 14.3) with the Quality step (14.4), on bipolar edges with the lazy queue of 14.1.3: a closed
/// 2-manifold triangulation of the oracle's surface, vertices on it. A limit or an unmet criterion is told in the
/// report, and the mesh is what there was. Throws OptionError, NothingToMesh, Cancelled.
SurfaceMesh delsurf(const Oracle& oracle, const DelSurfOptions& options, RunReport& report);

}  // namespace delvox
