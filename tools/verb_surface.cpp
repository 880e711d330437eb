#include "meshing_pipeline.h"

namespace delvox::tools {

void run_surface(const Verb& verb, const Arguments& arguments) {
  run_meshing(verb, arguments, MeshKind::kSurface, InputKind::kVolume);
}

}  // namespace delvox::tools
