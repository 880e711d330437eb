#include "delaunay/delaunay3.h"

namespace delvox {

Delaunay3::Delaunay3(const Box3& bounds) {
  triangulation_.infinite_vertex()->info() = kNone;
  const Point3 c = bounds.center();
  // Far enough that no circumcentre of a cell with a corner can lie in `bounds`; odd factors keep the corners off the
  // planes and spheres of the data.
  const double far = 7.31 * bounds.diagonal();
  for (const Point3& corner : {Point3{1.01, 1.02, 1.03}, Point3{1.04, -1.05, -1.06}, Point3{-1.07, 1.08, -1.09},
                               Point3{-1.1, -1.11, 1.12}}) {
    insert_unnamed(c + far * corner);
  }
  name_all_cells();
}

VertexId Delaunay3::name_vertex(Triangulation::Vertex_handle handle) {
  VertexId id;
  if (free_vertices_.empty()) {
    id = static_cast<VertexId>(vertices_.size());
    vertices_.push_back(handle);
  } else {
    id = free_vertices_.back();
    free_vertices_.pop_back();
    vertices_[id] = handle;
  }
  handle->info() = id;
  return id;
}

CellId Delaunay3::name_cell(Triangulation::Cell_handle handle) {
  CellId id;
  if (free_cells_.empty()) {
    id = static_cast<CellId>(cells_.size());
    cells_.push_back(handle);
    links_.emplace_back();
  } else {
    id = free_cells_.back();
    free_cells_.pop_back();
    cells_[id] = handle;
  }
  handle->info() = id;
  return id;
}

void Delaunay3::copy_links(CellId cell) {
  const auto& handle = cells_[cell];
  for (int i = 0; i < 4; ++i) {
    links_[cell].vertices[i] = handle->vertex(i)->info();
    links_[cell].neighbors[i] = handle->neighbor(i)->info();
  }
}

void Delaunay3::name_all_cells() {
  cells_.clear();
  free_cells_.clear();
  const auto& structure = triangulation_.tds();
  cells_.reserve(structure.number_of_cells());
  for (auto cell = structure.cells_begin(); cell != structure.cells_end(); ++cell) {
    cell->info() = static_cast<CellId>(cells_.size());
    cells_.push_back(cell);
  }
  links_.resize(cells_.size());
  for (CellId cell = 0; cell < cells_.size(); ++cell) copy_links(cell);
}

CellId Delaunay3::locate(const Point3& p, CellId hint) const {
  return triangulation_.locate({p.x, p.y, p.z}, cells_[hint])->info();
}

bool Delaunay3::in_conflict(CellId cell, const Point3& p) const {
  return triangulation_.side_of_sphere(cells_[cell], {p.x, p.y, p.z}, true) == CGAL::ON_BOUNDED_SIDE;
}

bool Delaunay3::is_vertex_of(CellId cell, const Point3& p) const {
  for (VertexId v : links_[cell].vertices) {
    if (v != kNone && point(v) == p) return true;
  }
  return false;
}

VertexId Delaunay3::insert_in_hole(const Point3& p, const std::vector<CellId>& zone,
                                   const std::vector<FacetId>& boundary, std::vector<CellId>& created) {
  handles_.clear();
  outer_.clear();
  for (CellId cell : zone) handles_.push_back(cells_[cell]);
  for (const FacetId& facet : boundary) outer_.push_back(mirror(facet));
  const auto handle = triangulation_.insert_in_hole({p.x, p.y, p.z}, handles_.begin(), handles_.end(),
                                                    cells_[boundary.front().cell], boundary.front().index);
  const VertexId vertex = name_vertex(handle);
  // Freed in reverse, so that the zone's first cell is used first again: neighbours stay near in memory.
  for (auto cell = zone.rbegin(); cell != zone.rend(); ++cell) free_cells_.push_back(*cell);
  created.clear();
  for (const FacetId& facet : outer_) {
    const CellId cell = name_cell(cells_[facet.cell]->neighbor(facet.index));
    links_[facet.cell].neighbors[facet.index] = cell;
    created.push_back(cell);
  }
  for (CellId cell : created) copy_links(cell);
  return vertex;
}

VertexId Delaunay3::insert_unnamed(const Point3& p) {
  const std::size_t before = triangulation_.number_of_vertices();
  const auto vertex = triangulation_.insert({p.x, p.y, p.z}, last_);
  last_ = vertex->cell();
  return triangulation_.number_of_vertices() == before ? vertex->info() : name_vertex(vertex);
}

void Delaunay3::remove(VertexId vertex, std::vector<CellId>& destroyed, std::vector<CellId>& created) {
  destroyed.clear();
  created.clear();
  handles_.clear();
  triangulation_.incident_cells(vertices_[vertex], std::back_inserter(handles_));
  for (const auto& handle : handles_) destroyed.push_back(handle->info());
  handles_.clear();
  triangulation_.remove_and_give_new_cells(vertices_[vertex], std::back_inserter(handles_));
  for (CellId cell : destroyed) free_cells_.push_back(cell);
  for (const auto& handle : handles_) created.push_back(name_cell(handle));
  for (CellId cell : created) {
    copy_links(cell);
    for (int i = 0; i < 4; ++i) copy_links(cells_[cell]->neighbor(i)->info());
  }
  vertices_[vertex] = Triangulation::Vertex_handle();
  free_vertices_.push_back(vertex);
}

}  // namespace delvox
