#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "delaunay/delaunay3.h"

namespace delvox {

/// The tetrahedra that take the place of a vertex and its cells. A second, small triangulation of the vertices around
/// it and the same corners holds them: since the perturbed Delaunay triangulation is unique, they are its cells inside
/// the hole, whatever the vertex's neighbours look like.
class Delaunay3::HoleFilling {
 public:
  struct Side {
    std::uint32_t tet = kNone;  ///< neighbour among the tets, or
    FacetId outer;              ///< beyond the wall of the hole
  };
  struct Tet {
    std::array<VertexId, 4> vertices;
    std::array<Side, 4> sides;
    Circumsphere sphere;
  };

  explicit HoleFilling(const Box3& bounds) : around_(bounds) {}

  /// Fills the hole that `cells`, those around `vertex` in `whole`, would leave.
  void find(const Delaunay3& whole, VertexId vertex, const std::vector<CellId>& cells);
  const std::vector<Tet>& tets() const { return tets_; }

 private:
  using Corners = std::array<VertexId, 3>;

  void insert_neighbours(const Delaunay3& whole, VertexId vertex, const std::vector<CellId>& cells);
  void find_walls(const Delaunay3& whole, VertexId vertex, const std::vector<CellId>& cells);
  const FacetId* wall_at(FacetId facet) const;
  CellId cell_inside(const Corners& wall) const;
  void flood();
  std::uint32_t number_of(CellId cell);

  Delaunay3 around_;
  std::vector<VertexId> name_in_whole_;                        // of each vertex of around_
  std::vector<std::pair<VertexId, VertexId>> name_in_around_;  // sorted by the name in the whole
  std::vector<std::pair<Corners, FacetId>> walls_;             // sorted; corners as seen from outside the hole
  std::vector<std::uint32_t> numbers_;                         // of each cell of around_ among the tets, or kNone
  std::vector<CellId> filling_;                                // cell of around_ of each tet
  std::vector<Tet> tets_;
  Star star_;
  std::vector<CellId> created_;
};

}  // namespace delvox
