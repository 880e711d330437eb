#pragma once

#include <functional>

#include "delvox/oracle/oracle.h"
#include "oracle/polygon_surface.h"
#include "oracle/samples_triangulation.h"

namespace delvox {

/// Where the surface is to cross the edge vw of a finite cell: a point between samples v, which is inside, and w, which
/// is not.
using PlaceOnEdge = std::function<Point3(std::uint32_t cell, std::uint32_t v, std::uint32_t w)>;

/// The isosurface of samples as polygons: of each tet a triangle or two, of the convex hull what is inside. `levels`:
/// one per sample, positive inside, none 0. Closed, oriented outward, with a topology that rounding cannot change,
/// since points are one if they lie on one edge.
PolygonSurface samples_surface(const SampleTriangulation& triangulation, const std::vector<double>& levels,
                               const PlaceOnEdge& place);

/// Calls visit for the tets that lie inside as a whole or in part, under linear interpolation, as boxes of at least
/// that width.
void visit_samples_patches(const SampleTriangulation& triangulation, const std::vector<double>& levels, double width,
                           const std::function<void(const DomainPatch&)>& visit);

/// Of a finite cell, the part of its volume that is inside under linear interpolation, mm3.
double inside_mm3_of(const SampleTriangulation& triangulation, const std::vector<double>& levels, std::uint32_t cell);

/// Where linear interpolation between v and w has level 0. Does not depend on their order.
Point3 linear_place(const SampleTriangulation& triangulation, const std::vector<double>& levels, std::uint32_t v,
                    std::uint32_t w);

}  // namespace delvox
