#pragma once

#include "check/report_builder.h"
#include "check/voxel_checks.h"

namespace delvox::check {

/// The checks that need the function whose zero set a mesh approximates: nodes on it, topology and distances both ways,
/// the last two with what a grid of samples shows of it. pre: options.function is set.
void check_against_function(const SurfaceOfMesh& mesh, const CheckOptions& options, ReportBuilder& builder,
                            CheckReport& report);

}  // namespace delvox::check
