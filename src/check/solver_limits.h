#pragma once

#include <vector>

#include "delvox/check/check_mesh.h"

namespace delvox::check {

/// What solvers measure of each tet, by their own definitions, and what they would object to.
struct SolverMeasures {
  Distribution face_angles, aspect_ratios, shape_factors, jacobian_ratios;
  std::vector<SolverLimit> limits;
};

/// pre: indices valid.
SolverMeasures measure_for_solvers(const TetMesh& mesh);

}  // namespace delvox::check
