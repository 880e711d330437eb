#pragma once

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

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

  /// False for cells with the infinite vertex.
  bool finite(CellId cell) const { return !triangulation_.is_infinite(cells_[cell]); }
  VertexId vertex(CellId cell, int i) const { return cells_[cell]->vertex(i)->info(); }
  CellId neighbor(CellId cell, int i) const { return cells_[cell]->neighbor(i)->info(); }
  FacetId mirror(FacetId facet) const {
    const auto handle = cells_[facet.cell];
    const auto other = handle->neighbor(facet.index);
    return {other->info(), other->index(handle)};
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

  /// Replaces the conflict zone by the star of p; `boundary` is one facet of the zone's boundary, seen from inside it.
  /// The zone's cell numbers are free afterwards; new cells have none until name_cell.
  VertexId insert_in_hole(const Point3& p, const std::vector<CellId>& zone, FacetId boundary);
  /// Numbers the new cell on the other side of `facet`.
  CellId name_new_cell_beyond(FacetId facet);
  /// Inserts with CGAL's own search; new cells have no numbers until name_all_cells().
  VertexId insert_unnamed(const Point3& p);
  /// Numbers every cell from 0; numbers used before are void.
  void name_all_cells();
  /// Removes a vertex; `created` receives the numbers of the cells that fill the hole, `destroyed` those freed.
  void remove(VertexId vertex, std::vector<CellId>& destroyed, std::vector<CellId>& created);
  void incident_cells(VertexId vertex, std::vector<CellId>& out) const;

 private:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = StampedVertexBase<Kernel>;
  using CellBase =
      CGAL::Triangulation_cell_base_with_info_3<CellId, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
  using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

  VertexId name_vertex(Triangulation::Vertex_handle handle);
  CellId name_cell(Triangulation::Cell_handle handle);

  Triangulation triangulation_;
  std::vector<Triangulation::Cell_handle> cells_;
  std::vector<Triangulation::Vertex_handle> vertices_;
  std::vector<CellId> free_cells_;
  std::vector<VertexId> free_vertices_;
  Triangulation::Cell_handle last_;
  mutable std::vector<Triangulation::Cell_handle> handles_;  // scratch
};

}  // namespace delvox
