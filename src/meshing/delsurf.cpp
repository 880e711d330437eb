#include "delvox/meshing/delsurf.h"

#include "meshing/check_options.h"
#include "meshing/extract.h"
#include "meshing/refinement.h"

namespace delvox {

// DelSurf(Sigma, lambda), book section 14.3, with Quality of 14.4. Seeds on every component stand in for the persistent
// triangle of steps 1 and 4 (figure 14.3 and the text above it); restricted triangles are those dual to bipolar edges.
SurfaceMesh delsurf(const Oracle& oracle, const DelSurfOptions& options, RunReport& report) {
  check_criteria(options.surface);
  report = RunReport{};
  Refinement refinement(oracle, options.surface, options.control, report);
  RunBudget& budget = refinement.budget();

  budget.begin_stage("seeds");
  refinement.insert_seeds();  // step 1
  do {
    budget.begin_stage("surface");
    refinement.refine();  // step 2, Quality
    budget.begin_stage("topology");
  } while (refinement.repair());  // step 3
  budget.end_stage();

  refinement.report_unmet();
  refinement.retire();
  SurfaceMesh mesh = extract_surface(refinement.delaunay());  // step 5
  mesh.info.promises = promises_of(options.surface);
  withdraw_unmet(report, mesh.info.promises);
  mesh.info.complete = report.succeeded();
  return mesh;
}

}  // namespace delvox
