#include "delvox/meshing/deltetsurf.h"

#include "meshing/check_options.h"
#include "meshing/extract.h"
#include "meshing/refinement.h"

namespace delvox {

// DelTetSurf(Sigma, lambda, rho), book section 14.5. With Restricted::kBipolar it is the isosurface variant: the
// boundary of Del|O stands in for Del|Sigma, so that step 4 falls away (end of 14.5); with kAll, step 4 acts along with
// step 3. Seeds on every component may stand in for the persistent triangle of steps 1 and 6. The surface converges
// before any interior vertex exists: an interior vertex that a later surface vertex exposes must be removed again (step
// 2).
TetMesh deltetsurf(const Oracle& oracle, const DelTetSurfOptions& options, RunReport& report) {
  check_criteria(options.surface);
  check_criteria(options.tets);
  check_min_fold(options.min_fold_degrees);
  report = RunReport{};
  Refinement refinement(oracle, options.surface, options.control, options.variant, report);
  RunBudget& budget = refinement.budget();

  budget.begin_stage("seeds");
  refinement.keep_features(options.tets.cell_size.minimum(), true);
  refinement.start();  // step 1
  const auto repair_surface = [&] {
    budget.begin_stage("topology");
    if (refinement.repair()) return true;  // step 5
    if (options.min_fold_degrees == 0) return false;
    budget.begin_stage("folds");
    return refinement.repair_folds(options.min_fold_degrees);
  };
  do {
    do {
      budget.begin_stage("surface");
      refinement.refine();  // steps 2 to 4, Quality
    } while (repair_surface());
  } while (refinement.delete_persistent_vertex() || refinement.smooth());  // step 6, Smooth (14.4)
  budget.begin_stage("interior");
  refinement.fill_interior(options.tets);  // not in the book: most of what step 7 would insert, at once
  refinement.watch_tets(options.tets);
  do {
    budget.begin_stage("tets");
    refinement.refine();  // step 7, returning to steps 2 to 4 after each surface insertion
  } while (repair_surface() || refinement.smooth());
  budget.end_stage();

  refinement.report_unmet();
  refinement.retire();
  TetMesh mesh = extract_tets(refinement.delaunay(), refinement.feature_edges());  // step 8
  mesh.info.promises = promises_of(options.surface, options.tets);
  withdraw_unmet(report, mesh.info.promises);
  mesh.info.complete = report.succeeded();
  return mesh;
}

}  // namespace delvox
