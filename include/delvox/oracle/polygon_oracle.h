#pragma once

#include <memory>

#include "delvox/core/mesh.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

/// What a triangulated surface encloses: points from which a ray crosses it an odd number of times, so that shells may
/// be nested, and face inward or outward. Points on the surface count as inside. Crossings lie on the triangles to
/// rounding, and their number is exact. Equal points are one, whatever their numbers; unused points do not matter.
/// Throws InputError, without a file's name, that tells the place and the triangles, counted from 0 as in `mesh`, if
/// the surface is empty, open, not manifold, not orientable, crosses itself, or has a triangle without area.
std::unique_ptr<Oracle> make_polygon_oracle(const SurfaceMesh& mesh);

}  // namespace delvox
