#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/restricted_delaunay.h"

namespace delvox {

/// Two restricted triangles that meet in an edge, and a wedge of the domain between them: whatever tets fill it have to
/// share its angle.
struct Fold {
  struct Side {
    FacetId facet;        ///< of a cell of the domain
    std::uint32_t stamp;  ///< of that cell
  };
  std::array<Side, 2> sides;
};

/// The folds whose wedge is sharper than a bound, up to 90 degrees, if one of their triangles is new: a facet of a cell
/// with the stamp `new_from` or a later one. Each comes once, in an order that depends on the triangulation alone.
std::vector<Fold> sharp_folds(const RestrictedDelaunay& delaunay, double min_degrees, std::uint32_t new_from);

}  // namespace delvox
