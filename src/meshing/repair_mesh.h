#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "delvox/core/mesh.h"
#include "meshing/incidence_lists.h"

namespace delvox {

/// Whether a tet or triangle has a vertex among its corners.
template <class Cell>
bool has_corner(const Cell& cell, std::uint32_t vertex) {
  return std::find(cell.begin(), cell.end(), vertex) != cell.end();
}

/// Tets, and triangles of the boundary, that take the place of others.
struct Change {
  std::vector<std::uint32_t> old_tets, old_triangles;
  std::vector<Tet> new_tets;
  std::vector<Triangle> new_triangles;

  void clear() {
    old_tets.clear();
    old_triangles.clear();
    new_tets.clear();
    new_triangles.clear();
  }
};

/// A tet mesh that is changed in places: plain arrays, and what meets at each vertex.
class RepairMesh {
 public:
  /// pre: mesh.boundary is the boundary of mesh.tets. Takes hold of the mesh until finish().
  explicit RepairMesh(TetMesh& mesh);

  const Point3& point(std::uint32_t vertex) const { return mesh_.points[vertex]; }
  void move(std::uint32_t vertex, const Point3& place);
  std::uint32_t point_count() const { return static_cast<std::uint32_t>(mesh_.points.size()); }
  /// pre: alive(tet).
  const Tet& tet(std::uint32_t tet) const { return mesh_.tets[tet]; }
  bool alive(std::uint32_t tet) const { return mesh_.tets[tet][0] != kDead; }
  Label region(std::uint32_t tet) const { return mesh_.regions.empty() ? 1 : mesh_.regions[tet]; }
  std::size_t triangle_count() const { return mesh_.boundary.size(); }
  /// pre: triangle_alive(triangle).
  const Triangle& triangle(std::uint32_t triangle) const { return mesh_.boundary[triangle]; }
  bool triangle_alive(std::uint32_t triangle) const { return mesh_.boundary[triangle][0] != kDead; }

  /// Tets at a vertex.
  std::span<const std::uint32_t> star(std::uint32_t vertex) const { return stars_.of(vertex); }
  /// Triangles of the boundary at a vertex.
  std::span<const std::uint32_t> fan(std::uint32_t vertex) const { return fans_.of(vertex); }
  bool on_boundary(std::uint32_t vertex) const { return !fans_.of(vertex).empty(); }
  /// Edges that follow sharp edges stay, and so do their ends.
  bool fixed(std::uint32_t vertex) const { return vertex < fixed_.size() && fixed_[vertex] != 0; }
  bool fixed_edge(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(fixed_edges_.begin(), fixed_edges_.end(), Edge{std::min(a, b), std::max(a, b)});
  }
  bool has_boundary_edge(std::uint32_t a, std::uint32_t b) const;
  static constexpr std::uint32_t kNone = ~0u;
  /// The tet on the other side of a face, or kNone.
  std::uint32_t across(std::uint32_t tet, int face) const;
  /// Number of the triangle of the boundary with these corners, or kNone.
  std::uint32_t boundary_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

  /// A vertex that is no corner yet.
  std::uint32_t add_vertex(const Point3& place, bool on_surface);
  /// Puts the new in place of the old. pre: the old tets are of one region.
  void apply(const Change& change);
  /// Numbers of what the last apply() made.
  const std::vector<std::uint32_t>& added_tets() const { return added_tets_; }
  const std::vector<std::uint32_t>& added_triangles() const { return added_triangles_; }
  /// From here on changes can be undone, until the trial is ended one way or the other.
  void begin_trial() { on_trial_ = true; }
  void keep_trial();
  /// All is as it was when the trial began, but for the order within lists.
  void undo_trial();
  /// Closes the gaps left in the arrays.
  void finish();

 private:
  static constexpr std::uint32_t kDead = ~0u;
  /// What is needed to take back one step: a vertex that was added or moved, or cells that came and went.
  struct Step {
    std::uint32_t vertex = kNone;
    bool added = false;
    Point3 place;
    std::vector<std::uint32_t> old_tets, new_tets, old_triangles, new_triangles;
    std::vector<Tet> tets;            // the old ones
    std::vector<Triangle> triangles;  // likewise
  };
  template <class Cell>
  void take_out(std::uint32_t number, std::vector<Cell>& cells, IncidenceLists& lists,
                std::vector<std::uint32_t>& free);
  template <class Cell>
  std::uint32_t put_in(const Cell& cell, std::vector<Cell>& cells, IncidenceLists& lists,
                       std::vector<std::uint32_t>& free);
  void undo(const Step& step);
  void drop_unused_points();

  TetMesh& mesh_;
  IncidenceLists stars_, fans_;
  std::vector<std::uint8_t> fixed_;
  std::vector<Edge> fixed_edges_;  // the lower number first, in order
  std::vector<std::uint32_t> free_tets_, free_triangles_, added_tets_, added_triangles_;
  std::vector<Step> journal_;
  bool on_trial_ = false;
};

}  // namespace delvox
