#pragma once

#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// All restricted triangles, each from the side of the larger label, in the order of the cells there.
std::vector<FacetId> restricted_triangles(const RestrictedDelaunay& delaunay);

}  // namespace delvox
