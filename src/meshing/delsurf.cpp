#include "delvox/meshing/delsurf.h"

#include <limits>

#include "delvox/core/errors.h"
#include "meshing/check_options.h"
#include "meshing/delsurf_steps.h"
#include "meshing/extract.h"

namespace delvox {

void promise(SurfaceMesh& mesh, const SurfaceCriteria& criteria, const RunReport& report) {
  mesh.info.promises = promises_of(criteria);
  withdraw_unmet(report, mesh.info.promises);
  mesh.info.complete = report.succeeded();
}

SurfaceMesh finished_surface(Refinement& refinement, const SurfaceCriteria& criteria, RunReport& report) {
  refinement.budget().end_stage();
  refinement.report_unmet();
  refinement.retire();
  SurfaceMesh mesh = extract_surface(refinement.delaunay(), refinement.feature_edges());
  promise(mesh, criteria, report);
  return mesh;
}

void refine_surface(Refinement& refinement) {
  RunBudget& budget = refinement.budget();
  do {
    do {
      budget.begin_stage("surface");
      refinement.refine();  // step 2, Quality
      budget.begin_stage("topology");
    } while (refinement.repair());                                         // step 3
  } while (refinement.delete_persistent_vertex() || refinement.smooth());  // step 4, Smooth
}

// DelSurf(Sigma, lambda), book section 14.3, with Quality and Smooth of 14.4. Seeds on every component may stand in for
// the persistent triangle of steps 1 and 4 (figure 14.3 and the text above it). Quality acts along with step 2, once
// the persistent triangle is gone.
SurfaceMesh delsurf(const Oracle& oracle, const DelSurfOptions& options, RunReport& report) {
  check_criteria(options.surface);
  report = RunReport{};
  if (options.surface_only_after_dense) return delsurf_once_dense(oracle, options, report);
  Refinement refinement(oracle, options.surface, options.control, options.variant, report);
  refinement.budget().begin_stage("seeds");
  refinement.keep_features(std::numeric_limits<double>::infinity(), false);
  refinement.start();  // step 1
  refine_surface(refinement);
  return finished_surface(refinement, options.surface, report);  // step 5
}

// DelSurf1(Sigma, lambda), book section 14.1, with 14.1.2: the loop goes on as long as there are vertices of persistent
// triangles to delete.
SurfaceMesh delsurf1(const Oracle& oracle, const DelSurfOptions& options, RunReport& report) {
  check_criteria(options.surface);
  refuse_features(options.surface, "delsurf1");
  if (options.surface_only_after_dense) throw OptionError("surface-only-after-dense: not with delsurf1");
  report = RunReport{};
  Refinement refinement(oracle, options.surface, options.control, options.variant, report);
  RunBudget& budget = refinement.budget();

  budget.begin_stage("seeds");
  refinement.start();  // step 1
  budget.begin_stage("surface");
  do {
    refinement.refine();  // step 2
  } while (refinement.mend_inadequate() || refinement.delete_persistent_vertex());
  return finished_surface(refinement, options.surface, report);  // step 3
}

}  // namespace delvox
