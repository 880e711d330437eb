#pragma once

#include <functional>
#include <optional>
#include <string>

#include "delvox/meshing/forecast.h"
#include "process_memory.h"

namespace delvox::tools {

/// A forecast of a run in the memory of a process that has read the volume.
struct ProcessForecast {
  Forecast mesh;
  ProcessMemory before;

  /// What the process will have held at most, bytes.
  double peak_bytes() const;
};

/// A run that ends at so many vertices (0: no limit) takes that part of what it would have taken.
Forecast limited(Forecast forecast, std::size_t max_vertices);

/// One line for people. `extra`: what the forecast does not count; empty: nothing.
std::string describe(const ProcessForecast& forecast, const std::string& extra = {});

/// "about 52,000 vertices, 280,000 tets", and what there is at least if it has thin parts.
std::string elements(const Forecast& forecast);

/// "1.5 GB", in powers of 1024.
std::string memory_text(double bytes);
/// The bytes that "4G", "800M" or "1500000" mean, in powers of 1024. Throws OptionError that names `option`.
double parse_memory(const std::string& text, const std::string& option);

/// The least factor, to a percent, by which sizes are to grow for the forecast to stay below `max_bytes` with a few
/// percent to spare; nothing if no factor does that and leaves a mesh worth the name. pre: a factor of 1 does not.
std::optional<double> factor_that_fits(const std::function<ProcessForecast(double factor)>& forecast_at,
                                       double max_bytes);

}  // namespace delvox::tools
