#pragma once

#include <string>

#include "delvox/check/check_mesh.h"
#include "delvox/core/run.h"

namespace delvox::tools {

/// Empty if the run finished and every promise holds; else one line: what does not hold, where, what to do.
std::string verdict(const RunReport& run, const CheckReport& check);

/// The same for a check alone.
std::string verdict(const CheckReport& check);

/// "topology: 3 places, first near x, y, z (reason)".
std::string describe(const Unmet& unmet);

}  // namespace delvox::tools
