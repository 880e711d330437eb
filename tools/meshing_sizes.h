#pragma once

#include <optional>
#include <string>

#include "console.h"
#include "delvox/core/size_field.h"
#include "meshing_domain.h"
#include "meshing_options.h"
#include "size_request.h"
#include "stopwatch.h"

namespace delvox::tools {

/// The sizes of a run, in the input's frame.
struct MeshingSizes {
  SizeField size = 1.0;
  std::optional<SizeField> cell_size;  ///< unset: as the size
  std::string sentence;                ///< what they are and where they come from
  std::optional<SizeRequest> request;  ///< what --size asked for
};

/// What the options and the domain say, without looking at the surface; notes what was chosen. Throws OptionError,
/// InputError.
MeshingSizes decide_sizes(const MeshingOptions& options, const MeshingDomain& domain, const Console& console);

/// Finds what depends on the surface, from one that is looked at as finely as the default size would show it; and makes
/// fields 1-Lipschitz for DelSurf1 and persistent triangles, which ask for that. Throws as SizeRequest::on() does.
void find_on_surface(MeshingSizes& sizes, const MeshingOptions& options, MeshingDomain& domain, Stopwatch& watch,
                     const Console& console);

}  // namespace delvox::tools
