#pragma once

#include "check/report_builder.h"
#include "check/voxel_checks.h"

namespace delvox::check {

/// The checks that need the polygon surface that a mesh was made from: topology, and distances both ways.
/// pre: options.surface is set.
void check_against_surface(const SurfaceOfMesh& mesh, const CheckOptions& options, ReportBuilder& builder,
                           CheckReport& report);

/// Whether two surfaces have as many components and the same Euler number: a failure if options ask for it.
void compare_topology(const SurfaceOfMesh& mesh, const std::string& other, std::size_t components, long euler,
                      const CheckOptions& options, ReportBuilder& builder);

}  // namespace delvox::check
