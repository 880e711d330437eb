#pragma once

#include <string>
#include <string_view>

#include "delvox/core/mesh.h"

namespace delvox::mesh_io {

/// The line that stands in every format with comments: frame, unit, and whether a limit stopped the run. At most 79
/// characters, no "--" (XML), no comma or semicolon. Slicer looks for SPACE=RAS or SPACE=LPS in headers.
std::string header_comment(const MeshInfo& info);

/// Takes the frame, and what else header_comment says, from a comment of any program.
void read_header_comment(std::string_view comment, MeshInfo& info);

}  // namespace delvox::mesh_io
