#pragma once

#include "delvox/core/mesh.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"

namespace delvox {

/// Throws OptionError unless the criteria are such that refinement is known to end (book, 14.4 and 14.5).
void check_criteria(const SurfaceCriteria& criteria);
void check_criteria(const TetCriteria& criteria);
/// Throws OptionError unless a bound on folds is from 0 to 90 degrees.
void check_min_fold(double degrees);

/// The criteria as promises; size fields promise their maximum.
Promises promises_of(const SurfaceCriteria& criteria);
Promises promises_of(const SurfaceCriteria& surface, const TetCriteria& tets);

/// Takes back the promises of bounds on deviation and roughness beyond which the run had to leave some triangles.
void withdraw_unmet(const RunReport& report, Promises& promises);

}  // namespace delvox
