#include "meshing/repair_mesh.h"

#include <utility>

namespace delvox {
RepairMesh::RepairMesh(TetMesh& mesh)
    : mesh_(mesh), stars_(mesh.points.size(), mesh.tets), fans_(mesh.points.size(), mesh.boundary) {
  if (mesh.features.empty()) return;
  fixed_.assign(mesh.points.size(), 0);
  for (const Edge& edge : mesh.features) {
    fixed_edges_.push_back({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
    for (std::uint32_t v : edge) fixed_[v] = 1;
  }
  std::sort(fixed_edges_.begin(), fixed_edges_.end());
}

bool RepairMesh::has_boundary_edge(std::uint32_t a, std::uint32_t b) const {
  const auto around = fan(a);
  return std::any_of(around.begin(), around.end(), [&](std::uint32_t t) { return has_corner(mesh_.boundary[t], b); });
}

std::uint32_t RepairMesh::across(std::uint32_t tet, int face) const {
  const Tet& corners = mesh_.tets[tet];
  const std::uint32_t a = corners[kTetFaces[face][0]], b = corners[kTetFaces[face][1]], c = corners[kTetFaces[face][2]];
  for (std::uint32_t t : star(a)) {
    if (t != tet && has_corner(mesh_.tets[t], b) && has_corner(mesh_.tets[t], c)) return t;
  }
  return kNone;
}

std::uint32_t RepairMesh::boundary_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  for (std::uint32_t t : fan(a)) {
    if (has_corner(mesh_.boundary[t], b) && has_corner(mesh_.boundary[t], c)) return t;
  }
  return kNone;
}

std::uint32_t RepairMesh::add_vertex(const Point3& place, bool on_surface) {
  const auto vertex = static_cast<std::uint32_t>(mesh_.points.size());
  mesh_.points.push_back(place);
  if (!mesh_.on_surface.empty()) mesh_.on_surface.push_back(on_surface ? 1 : 0);
  stars_.add_vertex();
  fans_.add_vertex();
  if (on_trial_) journal_.push_back({vertex, true, {}, {}, {}, {}, {}, {}, {}});
  return vertex;
}

void RepairMesh::move(std::uint32_t vertex, const Point3& place) {
  if (on_trial_) journal_.push_back({vertex, false, mesh_.points[vertex], {}, {}, {}, {}, {}, {}});
  mesh_.points[vertex] = place;
}

template <class Cell>
void RepairMesh::take_out(std::uint32_t number, std::vector<Cell>& cells, IncidenceLists& lists,
                          std::vector<std::uint32_t>& free) {
  for (std::uint32_t v : cells[number]) lists.remove(v, number);
  cells[number][0] = kDead;
  free.push_back(number);
}

template <class Cell>
std::uint32_t RepairMesh::put_in(const Cell& cell, std::vector<Cell>& cells, IncidenceLists& lists,
                                 std::vector<std::uint32_t>& free) {
  auto number = static_cast<std::uint32_t>(cells.size());
  if (free.empty()) {
    cells.push_back(cell);
  } else {
    number = free.back();
    free.pop_back();
    cells[number] = cell;
  }
  for (std::uint32_t v : cell) lists.add(v, number);
  return number;
}

void RepairMesh::apply(const Change& change) {
  Step step;
  if (on_trial_) {
    step.old_tets = change.old_tets;
    step.old_triangles = change.old_triangles;
    for (std::uint32_t t : change.old_tets) step.tets.push_back(mesh_.tets[t]);
    for (std::uint32_t t : change.old_triangles) step.triangles.push_back(mesh_.boundary[t]);
  }
  const Label label = region(change.old_tets[0]);
  for (std::uint32_t t : change.old_tets) take_out(t, mesh_.tets, stars_, free_tets_);
  for (std::uint32_t t : change.old_triangles) take_out(t, mesh_.boundary, fans_, free_triangles_);
  added_tets_.clear();
  added_triangles_.clear();
  for (const Tet& tet : change.new_tets) added_tets_.push_back(put_in(tet, mesh_.tets, stars_, free_tets_));
  for (const Triangle& triangle : change.new_triangles) {
    added_triangles_.push_back(put_in(triangle, mesh_.boundary, fans_, free_triangles_));
  }
  if (!mesh_.regions.empty()) {
    mesh_.regions.resize(mesh_.tets.size(), label);
    for (std::uint32_t t : added_tets_) mesh_.regions[t] = label;
  }
  if (!on_trial_) return;
  step.new_tets = added_tets_;
  step.new_triangles = added_triangles_;
  journal_.push_back(std::move(step));
}

void RepairMesh::keep_trial() {
  journal_.clear();
  on_trial_ = false;
}

void RepairMesh::undo_trial() {
  for (; !journal_.empty(); journal_.pop_back()) undo(journal_.back());
  on_trial_ = false;
}

// Numbers of cells that are gone lie on a stack: taken back in the reverse order, all get theirs again.
void RepairMesh::undo(const Step& step) {
  if (step.added) {
    mesh_.points.pop_back();
    if (!mesh_.on_surface.empty()) mesh_.on_surface.pop_back();
    stars_.remove_vertex();
    fans_.remove_vertex();
    return;
  }
  if (step.vertex != kNone) {
    mesh_.points[step.vertex] = step.place;
    return;
  }
  const auto undo_cells = [this](const auto& new_cells, const auto& old_cells, auto& cells, auto& lists, auto& free) {
    for (auto t = new_cells.rbegin(); t != new_cells.rend(); ++t) take_out(*t, cells, lists, free);
    for (auto cell = old_cells.rbegin(); cell != old_cells.rend(); ++cell) put_in(*cell, cells, lists, free);
  };
  const Label label = region(step.old_tets[0]);
  undo_cells(step.new_tets, step.tets, mesh_.tets, stars_, free_tets_);
  undo_cells(step.new_triangles, step.triangles, mesh_.boundary, fans_, free_triangles_);
  for (std::uint32_t t : step.old_tets) {
    if (!mesh_.regions.empty()) mesh_.regions[t] = label;
  }
}

void RepairMesh::finish() {
  const auto is_dead = [](const auto& cell) { return cell[0] == kDead; };
  if (!free_tets_.empty()) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (is_dead(mesh_.tets[t])) continue;
      mesh_.tets[kept] = mesh_.tets[t];
      if (!mesh_.regions.empty()) mesh_.regions[kept] = mesh_.regions[t];
      ++kept;
    }
    mesh_.tets.resize(kept);
    if (!mesh_.regions.empty()) mesh_.regions.resize(kept);
  }
  if (!free_triangles_.empty()) std::erase_if(mesh_.boundary, is_dead);
  drop_unused_points();
}

void RepairMesh::drop_unused_points() {
  std::vector<std::uint32_t> number(mesh_.points.size(), kNone);
  const auto unused = [this](std::uint32_t v) { return stars_.of(v).empty(); };
  std::uint32_t kept = 0;
  while (kept < mesh_.points.size() && !unused(kept)) ++kept;
  if (kept == mesh_.points.size()) return;
  kept = 0;
  for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
    if (unused(v)) continue;
    mesh_.points[kept] = mesh_.points[v];
    if (!mesh_.on_surface.empty()) mesh_.on_surface[kept] = mesh_.on_surface[v];
    number[v] = kept++;
  }
  mesh_.points.resize(kept);
  if (!mesh_.on_surface.empty()) mesh_.on_surface.resize(kept);
  for (Tet& tet : mesh_.tets) {
    for (std::uint32_t& v : tet) v = number[v];
  }
  for (Triangle& triangle : mesh_.boundary) {
    for (std::uint32_t& v : triangle) v = number[v];
  }
  for (Edge& edge : mesh_.features) {
    for (std::uint32_t& v : edge) v = number[v];
  }
}

}  // namespace delvox
