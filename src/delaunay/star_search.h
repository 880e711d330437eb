#pragma once

#include <cstdint>

#include "delaunay/edge_matcher.h"
#include "delaunay/scratch.h"
#include "delaunay/small_map.h"
#include "delaunay/star_spheres.h"

namespace delvox {

/// What a search of a triangulation needs for itself: with one each, several threads can search at a time.
struct StarSearch {
  SmallMap met;                    ///< cells, and whether each is what is sought
  Scratch<std::uint8_t> entered;  ///< of each cell of the zone, the facet that it was entered by
  EdgeMatcher edges;
  StarSpheres spheres;
};

}  // namespace delvox
