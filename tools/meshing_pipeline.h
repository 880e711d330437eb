#pragma once

#include "meshing_options.h"

namespace delvox::tools {

/// What `surface`, `remesh` and `tet` do, from the input file to the files of the mesh: read, preprocess, choose
/// isovalue and size, mesh, check, write, report. Throws Error; PromiseBroken if what was written is not what was promised.
void run_meshing(const Verb& verb, const Arguments& arguments, MeshKind kind, InputKind input);

}  // namespace delvox::tools
