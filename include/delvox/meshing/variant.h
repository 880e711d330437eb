#pragma once

#include <cstdint>

namespace delvox {

/// Step 1 of the book's algorithms: what the sample begins with.
enum class Start {
  kSeeds,       ///< a sample of every component (text above figure 14.3)
  kPersistent,  ///< a persistent triangle on every component (14.1), two of its vertices deleted at the end (14.1.2)
};

/// Which triangles are restricted Delaunay.
enum class Restricted {
  /// Those dual to bipolar Voronoi edges; other edges are intersected with the surface only where the mesh would else
  /// stay empty: the lazy strategy of 14.1.3, of tets the isosurface variant of 14.5.
  kBipolar,
  /// Those dual to edges that meet the surface at all: Del|Sigma. Triangles that face inside or outside with both sides
  /// are refined away (DelTetSurf, step 4).
  kAll,
};

/// Which of the book's variants of an algorithm is run.
struct Variant {
  Start start = Start::kSeeds;
  Restricted restricted = Restricted::kBipolar;
  std::uint64_t seed = 0;  ///< of the random choice of persistent triangles
};

}  // namespace delvox
