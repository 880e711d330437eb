#include "meshing/repair_mesh.h"

#include <algorithm>

namespace delvox {
namespace {

bool has(const auto& cell, std::uint32_t vertex) {
  return std::find(cell.begin(), cell.end(), vertex) != cell.end();
}

}  // namespace

RepairMesh::RepairMesh(TetMesh& mesh)
    : mesh_(mesh), stars_(mesh.points.size(), mesh.tets), fans_(mesh.points.size(), mesh.boundary) {}

bool RepairMesh::has_boundary_edge(std::uint32_t a, std::uint32_t b) const {
  const auto around = fan(a);
  return std::any_of(around.begin(), around.end(), [&](std::uint32_t t) { return has(mesh_.boundary[t], b); });
}

std::uint32_t RepairMesh::boundary_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  for (std::uint32_t t : fan(a)) {
    if (has(mesh_.boundary[t], b) && has(mesh_.boundary[t], c)) return t;
  }
  return kNone;
}

std::uint32_t RepairMesh::add_vertex(const Point3& place) {
  mesh_.points.push_back(place);
  if (!mesh_.on_surface.empty()) mesh_.on_surface.push_back(0);
  stars_.add_vertex();
  fans_.add_vertex();
  points_changed_ = true;
  return static_cast<std::uint32_t>(mesh_.points.size() - 1);
}

void RepairMesh::apply(const Change& change) {
  const Label label = region(change.old_tets[0]);
  for (std::uint32_t t : change.old_tets) {
    for (std::uint32_t v : mesh_.tets[t]) {
      stars_.remove(v, t);
      points_changed_ = points_changed_ || stars_.of(v).empty();
    }
    mesh_.tets[t][0] = kDead;
    free_tets_.push_back(t);
  }
  added_tets_.clear();
  for (const Tet& tet : change.new_tets) {
    std::uint32_t number = static_cast<std::uint32_t>(mesh_.tets.size());
    if (free_tets_.empty()) {
      mesh_.tets.push_back(tet);
      if (!mesh_.regions.empty()) mesh_.regions.push_back(label);
    } else {
      number = free_tets_.back();
      free_tets_.pop_back();
      mesh_.tets[number] = tet;
      if (!mesh_.regions.empty()) mesh_.regions[number] = label;
    }
    for (std::uint32_t v : tet) stars_.add(v, number);
    added_tets_.push_back(number);
  }
  replace_triangles(change);
}

void RepairMesh::replace_triangles(const Change& change) {
  for (std::uint32_t t : change.old_triangles) {
    for (std::uint32_t v : mesh_.boundary[t]) fans_.remove(v, t);
    mesh_.boundary[t][0] = kDead;
    free_triangles_.push_back(t);
  }
  added_triangles_.clear();
  for (const Triangle& triangle : change.new_triangles) {
    std::uint32_t number = static_cast<std::uint32_t>(mesh_.boundary.size());
    if (free_triangles_.empty()) {
      mesh_.boundary.push_back(triangle);
    } else {
      number = free_triangles_.back();
      free_triangles_.pop_back();
      mesh_.boundary[number] = triangle;
    }
    for (std::uint32_t v : triangle) fans_.add(v, number);
    added_triangles_.push_back(number);
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
  if (points_changed_) drop_unused_points();
}

void RepairMesh::drop_unused_points() {
  std::vector<std::uint32_t> number(mesh_.points.size(), kNone);
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
    if (stars_.of(v).empty()) continue;
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
}

}  // namespace delvox
