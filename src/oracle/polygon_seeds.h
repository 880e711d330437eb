#pragma once

#include "delvox/oracle/oracle.h"
#include "oracle/polygon_surface.h"

namespace delvox {

/// A well-spaced subset of the vertices (book, 14.4), Poisson-like at the wanted spacing, filled up with points
/// of triangles whose edges are longer than that, by a hash of their place. A component smaller than the spacing gets a
/// denser set of its own. When go_on says no, what there is by then is returned.
Seeds polygon_seeds(const PolygonSurface& surface, const SizeField& size, const GoOn& go_on);

}  // namespace delvox
