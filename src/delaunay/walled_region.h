#pragma once

#include <array>
#include <optional>
#include <vector>

#include "delaunay/ids.h"

namespace delvox {

class Delaunay3;

/// A facet of a closed surface, counter-clockwise seen from outside.
using Wall = std::array<VertexId, 3>;

/// What a closed surface of facets encloses.
struct WalledRegion {
  std::vector<CellId> cells;     ///< all within, ascending
  std::vector<FacetId> outside;  ///< for each wall, that facet of the cell beyond it
};

/// None if one of the walls is no facet of the triangulation.
std::optional<WalledRegion> find_walled_region(const Delaunay3& delaunay, const std::vector<Wall>& walls);

}  // namespace delvox
