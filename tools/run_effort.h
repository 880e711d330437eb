#pragma once

#include <optional>

#include "console.h"
#include "delvox/core/run.h"
#include "delvox/meshing/remove_slivers.h"

namespace delvox::tools {

/// With --verbose: how long each stage took, and what was inserted, removed and changed.
void tell_effort(const Console& console, const RunReport& run, const std::optional<SliverReport>& slivers);
/// Of --surface-only-after-dense: how many points were inserted where.
void tell_dense(const Console& console, const RunReport& run);

/// The first of the tets that were left with small dihedral angles: which angle, where, why.
void warn_of_slivers(const Console& console, const SliverReport& slivers);

}  // namespace delvox::tools
