#include <algorithm>
#include <cmath>
#include <sstream>

#include "contender.h"
#include "delvox/meshing/remove_slivers.h"
#include "delvox/oracle/isosurface_oracle.h"
#include "mesh_measures.h"

namespace delvox::bench {

DelTetSurfOptions program_options(const Volume& volume, const BenchCriteria& criteria) {
  const Vector3 spacing = volume.header().spacing();
  DelTetSurfOptions options;
  options.surface.size = criteria.size;
  options.surface.min_angle_degrees = criteria.angle_degrees;
  const double voxel = std::min({spacing.x, spacing.y, spacing.z});
  options.surface.min_ball_radius = 0.0001 * voxel;
  options.surface.thin_ball_radius = 0.25 * voxel;
  options.tets.cell_size = criteria.cell_size;
  options.tets.radius_edge = criteria.radius_edge;
  if (criteria.optimise) options.min_fold_degrees = min_fold_for(kMinDihedralDegrees);
  return options;
}

BenchRun run_delvox(const Volume& volume, const Isosurface& surface, const BenchCriteria& criteria) {
  const DelTetSurfOptions options = program_options(volume, criteria);
  BenchRun run;
  RunReport report;
  const Meter meter;
  const auto oracle = make_isosurface_oracle(volume, surface);
  const double oracle_bytes = meter.peak_bytes();
  run.mesh = deltetsurf(*oracle, options, report);
  if (criteria.optimise) {
    remove_slivers(run.mesh, *oracle, {kMinDihedralDegrees, options.surface, options.tets, {}}, report);
  }
  meter.stop(run);

  std::ostringstream note;
  for (const Unmet& unmet : report.unmet) {
    note << unmet.count << " unmet: " << unmet.criterion << (unmet.breaks_promise ? "" : " (no promise)") << "; ";
  }
  for (const StageTime& stage : report.stages) note << stage.stage << ' ' << stage.seconds << " s ";
  note << "(peak memory after the oracle " << std::lround(oracle_bytes / (1 << 20)) << " MB)";
  run.note = note.str();
  return run;
}

}  // namespace delvox::bench
