#pragma once

#include <utility>
#include <vector>

#include "oracle/samples_triangulation.h"

namespace delvox {

/// Linear interpolation at a point of a finite cell, its boundary included: a mean of its four values, by weights that
/// are exact where the cell is too flat for rounded ones.
double linear_value(const SampleTriangulation& triangulation, const std::vector<double>& values, std::uint32_t cell,
                    const Point3& p);

/// Sibson's natural neighbour coordinates of p (R. Sibson, "A brief description of natural neighbour interpolation",
/// 1981): of each sample the volume that p would take from its Voronoi cell, as a share of the whole; in the order in
/// which the cells around p name them. pre: p lies in `cell`, and at no sample. Empty where p lies on the boundary of
/// the convex hull: there the volumes are infinite. Rounded ones are put to the test that they yield p itself, and made
/// of exact numbers where they fail it.
std::vector<std::pair<std::uint32_t, double>> natural_coordinates(const SampleTriangulation& triangulation,
                                                                  std::uint32_t cell, const Point3& p);

/// The mean of the values by these; on the boundary of the hull that 1e-9 of the way towards the middle of the cell,
/// and so nearly its limit; in a cell too flat for that the linear one. pre: p lies in `cell`.
double natural_value(const SampleTriangulation& triangulation, const std::vector<double>& values, std::uint32_t cell,
                     const Point3& p);

/// A value with the sign of that one, and equal to it unless all samples around p have one sign: then the linear one,
/// in two thirds of the time. pre: p lies in `cell`.
double natural_level(const SampleTriangulation& triangulation, const std::vector<double>& levels, std::uint32_t cell,
                     const Point3& p);

}  // namespace delvox
