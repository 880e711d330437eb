#pragma once

#include <optional>
#include <string>

#include "delvox/check/check_mesh.h"
#include "delvox/core/run.h"
#include "delvox/oracle/oracle.h"
#include "delvox/volume/ties.h"

namespace delvox::tools {

/// Empty if the run finished and every promise holds; else one line: what does not hold, where, what to do (`advice`, if
/// there is better than the usual).
std::string verdict(const RunReport& run, const CheckReport& check, const std::string& advice = {});

/// The same for a check alone.
std::string verdict(const CheckReport& check);

/// What to do about samples that equal the isovalue: take one between sample values. Empty if there are none.
std::string advice_on(const Ties& ties);

/// What a mesh that holds all its promises lacks of its input, if that counts its own topology. `who`: "the input".
std::optional<Unmet> topology_shortfall(const CheckReport& check, const std::optional<SurfaceTopology>& input,
                                        const std::string& who);

/// "topology: 3 places, first near x, y, z (reason)", or "topology (reason)".
std::string describe(const Unmet& unmet);

}  // namespace delvox::tools
