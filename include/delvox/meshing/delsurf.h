#pragma once

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"
#include "delvox/meshing/variant.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What delsurf is asked for.
struct DelSurfOptions {
  SurfaceCriteria surface;
  RunControl control;
  Variant variant = {};
  /// Del S is kept until the sample is dense: what is left to split then is split without (book, exercise 3). For seeds,
  /// bipolar edges and no bound on roughness only. The mesh is held to the same; its triangles are restricted Delaunay,
  /// and its topology is that of Del|Sigma of the dense sample.
  bool surface_only_after_dense = false;
};

/// DelSurf (book, 14.3) with Quality and Smooth (14.4): a closed 2-manifold triangulation of the oracle's surface,
/// vertices on it. A limit or an unmet criterion is told in the report, and the mesh is what there was. Throws
/// OptionError, NothingToMesh, Cancelled.
SurfaceMesh delsurf(const Oracle& oracle, const DelSurfOptions& options, RunReport& report);

/// DelSurf1 (book, 14.1): for size fields that are 1-Lipschitz and at most 0.08 of the local feature size, with which
/// it keeps theorem 14.2. Others it cannot tell: nothing but the size is looked at, and the angle and deviation if they
/// are bounded, not the topology. Otherwise as delsurf(), but for surface_only_after_dense, which is refused
/// (OptionError).
SurfaceMesh delsurf1(const Oracle& oracle, const DelSurfOptions& options, RunReport& report);

}  // namespace delvox
