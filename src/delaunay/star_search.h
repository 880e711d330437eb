#pragma once

#include "delaunay/edge_matcher.h"
#include "delaunay/small_map.h"

namespace delvox {

/// What a search of a triangulation needs for itself: with one each, several threads can search at a time.
struct StarSearch {
  SmallMap met;  ///< cells, and whether each is what is sought
  EdgeMatcher edges;
};

}  // namespace delvox
