#pragma once

#include <array>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/mesh.h"

namespace delvox {

/// The restricted triangles, oriented outward, with the vertices they use. `features`: those of their edges that follow
/// sharp edges.
SurfaceMesh extract_surface(const RestrictedDelaunay& delaunay,
                            const std::vector<std::array<VertexId, 2>>& features = {});

/// The cells with a label other than 0, the triangles between them and the outside, and the vertices they use.
TetMesh extract_tets(const RestrictedDelaunay& delaunay, const std::vector<std::array<VertexId, 2>>& features = {});

}  // namespace delvox
