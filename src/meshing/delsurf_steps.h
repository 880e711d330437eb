#pragma once

#include "delvox/meshing/delsurf.h"
#include "meshing/refinement.h"

namespace delvox {

/// Steps 2 to 4 of DelSurf, until there is nothing left to do or the budget is used up.
void refine_surface(Refinement& refinement);

/// Step 5: the restricted triangles of a refinement that has ended, with what they promise.
SurfaceMesh finished_surface(Refinement& refinement, const SurfaceCriteria& criteria, RunReport& report);

/// What the mesh of a run that has ended promises.
void promise(SurfaceMesh& mesh, const SurfaceCriteria& criteria, const RunReport& report);

/// DelSurf without Del S once the sample is dense (dense_refinement.cpp). pre: seeds, bipolar, no Smooth.
SurfaceMesh delsurf_once_dense(const Oracle& oracle, const DelSurfOptions& options, RunReport& report);

}  // namespace delvox
