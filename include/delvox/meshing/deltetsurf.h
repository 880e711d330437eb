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
  /// Where two triangles of the boundary hold a wedge of the inside sharper than this between them, the surface is
  /// refined, until it is not or the balls are the smallest: tets can be no better than the wedge that they lie in.
  /// 0 to 90; 0 leaves folds as they are.
  double min_fold_degrees = 0;
};

/// DelTetSurf (book, 14.5), in its isosurface variant or on Del|Sigma as a whole: tetrahedra of the inside, whose
/// boundary is a closed 2-manifold with vertices on the oracle's surface. Where the circumcentre of a bad tet
/// encroaches on the surface, a point beside it goes in if that does not; else, as in the book, a point of the surface.
/// A limit or an unmet criterion is told in the report, and the mesh is what there was. Throws OptionError,
/// NothingToMesh, Cancelled.
TetMesh deltetsurf(const Oracle& oracle, const DelTetSurfOptions& options, RunReport& report);

}  // namespace delvox
