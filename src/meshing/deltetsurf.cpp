#include "delvox/meshing/deltetsurf.h"

#include "meshing/check_options.h"
#include "meshing/extract.h"
#include "meshing/refinement.h"

namespace delvox {

// DelTetSurf(Sigma, lambda, rho), book section 14.5, in its isosurface variant: the boundary of Del|O stands in for
// Del|Sigma, so that step 4 falls away (end of 14.5); seeds on every component stand in for the persistent triangle of
// steps 1 and 6. The surface converges before any interior vertex exists: an interior vertex that a later surface
// vertex exposes must be removed again (step 2).
TetMesh deltetsurf(const Oracle& oracle, const DelTetSurfOptions& options, RunReport& report) {
  check_criteria(options.surface);
  check_criteria(options.tets);
  check_min_fold(options.min_fold_degrees);
  report = RunReport{};
  Refinement refinement(oracle, options.surface, options.control, report);
  RunBudget& budget = refinement.budget();

  budget.begin_stage("seeds");
  refinement.insert_seeds();  // step 1
  const auto repair_surface = [&] {
    budget.begin_stage("topology");
    if (refinement.repair()) return true;  // step 5
    if (options.min_fold_degrees == 0) return false;
    budget.begin_stage("folds");
    return refinement.repair_folds(options.min_fold_degrees);
  };
  do {
    budget.begin_stage("surface");
    refinement.refine();  // steps 2 and 3, Quality
  } while (repair_surface());
  budget.begin_stage("interior");
  refinement.fill_interior(options.tets);  // not in the book: most of what step 7 would insert, at once
  refinement.watch_tets(options.tets);
  do {
    budget.begin_stage("tets");
    refinement.refine();  // step 7, returning to steps 2 and 3 after each surface insertion
  } while (repair_surface());
  budget.end_stage();

  refinement.report_unmet();
  refinement.retire();
  TetMesh mesh = extract_tets(refinement.delaunay(), refinement.deep() ? &*refinement.deep() : nullptr);  // step 8
  mesh.info.promises = promises_of(options.surface, options.tets);
  withdraw_unmet(report, mesh.info.promises);
  mesh.info.complete = report.succeeded();
  return mesh;
}

}  // namespace delvox
