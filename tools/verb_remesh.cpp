#include "meshing_pipeline.h"

namespace delvox::tools {

void run_remesh(const Verb& verb, const Arguments& arguments) {
  run_meshing(verb, arguments, MeshKind::kSurface, InputKind::kPolygons);
}

}  // namespace delvox::tools
