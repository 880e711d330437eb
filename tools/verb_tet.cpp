#include "meshing_pipeline.h"

namespace delvox::tools {

void run_tet(const Verb& verb, const Arguments& arguments) {
  run_meshing(verb, arguments, MeshKind::kTets, InputKind::kEither);
}

}  // namespace delvox::tools
