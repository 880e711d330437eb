#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/page_array.h"
#include "delaunay/circumsphere.h"
#include "delaunay/ids.h"
#include "delaunay/known_tets.h"
#include "delaunay/star.h"
#include "delaunay/star_search.h"
#include "delvox/core/geometry.h"
#include "delvox/core/mesh.h"

namespace delvox {

/// A Delaunay triangulation in flat arrays, with every cell's circumsphere at hand: as a filter it settles all but one
/// in a hundred in-sphere tests, exact predicates the rest. Numbers of dead cells and vertices are used again; a cell's
/// stamp tells whether it is still the cell that was meant.
///
/// Several insertions can be made at a time: each evaluates its star and claims the vertices of that, as none
/// changes anything yet; then those that hold all they have claimed are committed. What comes out does not depend on the
/// number of threads (deterministic reservations: Blelloch, Fineman, Gibbons, Shun, PPoPP 2012).
///
/// All lies inside one tetrahedron of four corner vertices (numbers below kCorners) far outside the data; the cell with
/// number kOutside stands for all that is beyond it.
class Delaunay3 {
 public:
  static constexpr CellId kOutside = 0;
  static constexpr VertexId kCorners = 4;
  static constexpr std::uint32_t kMostClaims = 16;  // of a round

  /// Every point inserted later must lie inside `bounds`.
  explicit Delaunay3(const Box3& bounds);
  ~Delaunay3();

  std::size_t cell_capacity() const { return cells_.size(); }
  std::size_t vertex_capacity() const { return vertices_.size(); }
  /// Corners included.
  std::size_t vertex_count() const { return vertex_count_.load(std::memory_order_relaxed); }

  /// 0 for cells that are not in use; changes whenever the number is given to another cell.
  std::uint32_t stamp(CellId cell) const { return stamps_[cell]; }
  /// What the next cell will get; stamps grow.
  std::uint32_t next_stamp() const { return next_stamp_; }
  /// In positive order; kNone for the cell outside.
  const std::array<VertexId, 4>& vertices(CellId cell) const { return cells_[cell].vertices; }
  const std::array<CellId, 4>& neighbors(CellId cell) const { return cells_[cell].neighbors; }
  const Circumsphere& sphere(CellId cell) const { return cells_[cell].sphere; }
  /// Counter-clockwise seen from outside the cell.
  std::array<VertexId, 3> vertices(FacetId facet) const {
    const auto& corners = kTetFaces[facet.index];
    const auto& v = cells_[facet.cell].vertices;
    return {v[corners[0]], v[corners[1]], v[corners[2]]};
  }
  /// The same facet, of the cell on its other side; of the cell outside, number 0.
  FacetId mirror(FacetId facet) const {
    const CellId other = cells_[facet.cell].neighbors[facet.index];
    const auto& back = cells_[other].neighbors;
    const int last = back[3] == facet.cell;  // without branches: which it is cannot be foreseen
    return {other, ((back[1] == facet.cell) | last) + 2 * ((back[2] == facet.cell) | last)};
  }
  const Point3& point(VertexId vertex) const { return vertices_[vertex].point; }
  /// Some cell at the vertex.
  CellId cell_of(VertexId vertex) const { return vertices_[vertex].cell; }

  void prefetch_vertex(VertexId vertex) const { vertices_.prefetch(vertex); }
  void prefetch(CellId cell) const {
    cells_.prefetch(cell);
    stamps_.prefetch(cell);
  }
  /// Tells the processor that a cell's neighbours will be asked for soon.
  void prefetch_neighbors(CellId cell) const {
    for (CellId neighbor : cells_[cell].neighbors) cells_.prefetch(neighbor);
  }
  /// The cell that contains p, by a walk from `hint`. pre: p inside the bounds.
  CellId locate(const Point3& p, CellId hint) const;
  /// Cells around a vertex other than a corner, in an order that depends on the triangulation alone.
  void find_incident_cells(VertexId vertex, std::vector<CellId>& cells, SmallMap& met) const;
  void find_incident_cells(VertexId vertex, std::vector<CellId>& cells) const {
    find_incident_cells(vertex, cells, search_.met);
  }

  /// Of some cells, those not in use being passed over: one that inserting p would destroy, or else the first, or else
  /// any.
  CellId nearest_hint(const Point3& p, const std::vector<CellId>& hints) const;
  /// What would inserting p do? Labels of the star are not set. `hint` is a cell near p.
  void evaluate(const Point3& p, CellId hint, Star& star) const { evaluate(p, hint, star, search_); }
  void evaluate(const Point3& p, CellId hint, Star& star, StarSearch& search) const {
    find_zone(p, hint, star, search);
    if (!star.duplicate) find_tets(star, search);
  }
  /// The first half of that: the zone, and what of the star's tets does not lie at the apex.
  void find_zone(const Point3& p, CellId hint, Star& star, StarSearch& search) const;
  /// The other half. pre: the search is as find_zone() has left it, !star.duplicate.
  void find_tets(Star& star, StarSearch& search) const;
  /// Inserts the apex of a star; `created` receives the new cells in the order of the star's tets, with the apex as
  /// their first vertex. pre: !star.duplicate, no change since it was evaluated.
  VertexId commit(const Star& star, std::vector<CellId>& created);

  /// Numbers set aside for the insertions of one lane, so that others can be made beside them.
  struct Room {
    std::vector<CellId> cells;
    VertexId vertex = kNone;
  };
  /// The first of a round of claims, greater than all before, for at most kMostClaims insertions that are to be made at
  /// a time.
  std::uint32_t new_claims() {
    const std::uint32_t first = (next_stamp_ + kMostClaims - 1) / kMostClaims * kMostClaims;
    next_stamp_ = first + kMostClaims;
    return first;
  }
  /// For an insertion that is made alone: no claim of old can keep it from a vertex.
  std::uint32_t new_claim() { return new_claims() + kMostClaims - 1; }
  /// Claims a vertex: the greatest claim of the round holds it. (What vertices remember of claims comes again after 4096
  /// rounds. A vertex that then happens to be held by a claim of old is held by nobody in this round, and is free in the
  /// next.)
  void claim(VertexId vertex, std::uint32_t claim) const;
  /// pre: the claim has been laid on the vertex, in this round.
  bool holds(VertexId vertex, std::uint32_t claim) const {
    return claims_[vertex] == static_cast<std::uint16_t>(claim);
  }
  /// Claims the star's vertices, which are far fewer than cells: stars of which one's zone holds a cell of the other's
  /// zone, or of those around it, have one in common that is none of the four far corners. These nearly all outer stars
  /// share; they are left out, unless there is nothing else yet.
  void claim(const Star& star, std::uint32_t claim) const;
  bool holds(const Star& star, std::uint32_t claim) const;
  /// Puts into the room what committing the star takes, and if that is not there yet, so many cells more. Not to be
  /// called beside anything else.
  void furnish(Room& room, const Star& star, std::size_t spare_cells = 0);
  /// Gives back what is left in the room.
  void clear_out(Room& room);
  /// As above, beside others. The cells' stamp is the claim. pre: holds(star, claim), or nothing is done beside; room
  /// furnished for the star.
  VertexId commit(const Star& star, std::uint32_t claim, Room& room, std::vector<CellId>& created);

  // Tets that are known, in place of what their walls enclose: what inserting their points would end in.

  /// First: numbers for their points and cells.
  void make_room_for(const KnownTets& known);
  /// Then each, beside others. `first_vertex`: of the numbers that their points have got; `stamp`: greater than all
  /// before.
  void set_known(CellId cell, const KnownTets::Tet& tet, VertexId first_vertex, std::uint32_t stamp);
  /// Then all of them take the place of the region that find_walled_region() found before.
  void put_in_place(const KnownTets& known, const WalledRegion& region);

  /// Removes a vertex; `destroyed` receives the numbers of the cells that are gone, `created` of those that fill the
  /// hole. pre: no corner.
  void remove(VertexId vertex, std::vector<CellId>& destroyed, std::vector<CellId>& created);

 private:
  struct alignas(64) Cell {
    std::array<VertexId, 4> vertices;
    std::array<CellId, 4> neighbors;
    Circumsphere sphere;
  };
  static_assert(sizeof(Cell) == 64);
  struct Vertex {
    Point3 point;
    CellId cell = kOutside;
  };
  class HoleFilling;

  void clear();
  void make_first_cell();
  bool in_conflict(CellId cell, const Point3& p) const;
  bool in_conflict_exactly(CellId cell, const Point3& p) const;
  bool is_vertex_of(CellId cell, const Point3& p) const;
  bool is_beyond(FacetId facet, const Point3& p) const;
  void grow_zone(const Point3& p, CellId start, Star& star, StarSearch& search) const;
  VertexId new_vertex();
  CellId new_cell();
  void grow_cells(std::size_t count);
  void set_cell(CellId cell, const std::array<VertexId, 4>& vertices, const Circumsphere& sphere);
  void repoint(const Star& star, const std::vector<CellId>& created);
  void join(FacetId facet, FacetId outer);
  template <class Gone>
  void offer_cell(VertexId vertex, CellId cell, const Gone& gone);

  Box3 bounds_;
  bool several_threads_;
  PageArray<Cell> cells_;
  PageArray<std::uint32_t> stamps_;
  PageArray<Vertex> vertices_;
  mutable PageArray<std::uint16_t> claims_;  // low bits of the greatest of the last round that laid one on the vertex
  std::vector<CellId> free_cells_;
  std::vector<VertexId> free_vertices_;
  double trusted_squared_radius_ = 0, orientation_error_ = 0;
  std::uint32_t next_stamp_ = 1;
  std::atomic<std::size_t> vertex_count_ = 0;
  Room room_;
  mutable StarSearch search_;
  std::unique_ptr<HoleFilling> hole_filling_;  // made by the first removal
};

}  // namespace delvox
