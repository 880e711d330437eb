#pragma once

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <array>
#include <cstdint>
#include <vector>

#include "delaunay/ids.h"
#include "delvox/core/geometry.h"

namespace delvox {

/// A vertex that carries its number, and its time of creation: CGAL then orders and hashes vertices by that, not by
/// address, and removals fill their holes alike on every run.
template <class Kernel, class Base = CGAL::Triangulation_vertex_base_with_info_3<VertexId, Kernel>>
class StampedVertexBase : public Base {
 public:
  template <class Structure>
  struct Rebind_TDS {
    using Other = StampedVertexBase<Kernel, typename Base::template Rebind_TDS<Structure>::Other>;
  };
  using Base::Base;
  using Has_timestamp = CGAL::Tag_true;
  std::size_t time_stamp() const { return stamp_; }
  void set_time_stamp(std::size_t stamp) { stamp_ = stamp; }

 private:
  std::size_t stamp_ = static_cast<std::size_t>(-1);
};

/// CGAL's Delaunay triangulation behind cell and vertex numbers. Numbers of dead cells and vertices are used again;
/// a cell's stamp tells whether it is still the cell that was meant.
class Delaunay3 {
 public:
  /// Starts with four corner vertices far outside `bounds`; every point inserted later must lie inside `bounds`,
  /// so that no cell with the infinite vertex is ever in conflict.
  explicit Delaunay3(const Box3& bounds);

  std::size_t cell_capacity() const { return cells_.size(); }
  std::size_t vertex_capacity() const { return vertices_.size(); }
  std::size_t vertex_count() const { return triangulation_.number_of_vertices(); }

  /// False for cells with the infinite vertex, whose number is kNone.
  bool finite(CellId cell) const {
    const auto& v = links_[cell].vertices;
    return v[0] != kNone && v[1] != kNone && v[2] != kNone && v[3] != kNone;
  }
  const std::array<VertexId, 4>& vertices(CellId cell) const { return links_[cell].vertices; }
  const std::array<CellId, 4>& neighbors(CellId cell) const { return links_[cell].neighbors; }
  FacetId mirror(FacetId facet) const {
    const CellId other = links_[facet.cell].neighbors[facet.index];
    const auto& back = links_[other].neighbors;
    // Two cells share one facet only, once there are more than five points.
    return {other, back[0] == facet.cell ? 0 : back[1] == facet.cell ? 1 : back[2] == facet.cell ? 2 : 3};
  }
  Point3 point(VertexId vertex) const {
    const auto& p = vertices_[vertex]->point();
    return {p.x(), p.y(), p.z()};
  }

  /// A cell that contains p, by a walk from `hint`.
  CellId locate(const Point3& p, CellId hint) const;
  /// Exactly whether p lies inside the circumsphere of `cell`, cospherical points decided by CGAL's perturbation.
  bool in_conflict(CellId cell, const Point3& p) const;
  bool is_vertex_of(CellId cell, const Point3& p) const;

  /// Replaces the conflict zone by the star of p. `boundary` holds the facets of the zone's boundary, seen from inside;
  /// `created` receives the new cells in the same order.
  VertexId insert_in_hole(const Point3& p, const std::vector<CellId>& zone, const std::vector<FacetId>& boundary,
                          std::vector<CellId>& created);
  /// Inserts with CGAL's own search; new cells have no numbers until name_all_cells().
  VertexId insert_unnamed(const Point3& p);
  /// Numbers every cell from 0; numbers used before are void.
  void name_all_cells();
  /// Removes a vertex; `created` receives the numbers of the cells that fill the hole, `destroyed` those freed.
  void remove(VertexId vertex, std::vector<CellId>& destroyed, std::vector<CellId>& created);
  /// Some cell at the vertex.
  CellId cell_of(VertexId vertex) const { return vertices_[vertex]->cell()->info(); }

 private:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = StampedVertexBase<Kernel>;
  using CellBase =
      CGAL::Triangulation_cell_base_with_info_3<CellId, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
  using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

  VertexId name_vertex(Triangulation::Vertex_handle handle);
  CellId name_cell(Triangulation::Cell_handle handle);
  void copy_links(CellId cell);

  /// CGAL's pointers as numbers: all that searches read, in half a cache line.
  struct Links {
    std::array<VertexId, 4> vertices;
    std::array<CellId, 4> neighbors;
  };

  Triangulation triangulation_;
  std::vector<Triangulation::Cell_handle> cells_;
  std::vector<Links> links_;
  std::vector<Triangulation::Vertex_handle> vertices_;
  std::vector<CellId> free_cells_;
  std::vector<VertexId> free_vertices_;
  Triangulation::Cell_handle last_;
  std::vector<Triangulation::Cell_handle> handles_;  // scratch
  std::vector<FacetId> outer_;                       // scratch
};

}  // namespace delvox
