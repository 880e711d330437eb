#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/page_array.h"
#include "core/parallel.h"
#include "core/team.h"
#include "delaunay/delaunay3.h"
#include "delaunay/known_tets.h"
#include "delaunay/lane.h"
#include "delaunay/surface_balls.h"
#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

enum class VertexKind : std::uint8_t { kCorner, kSurface, kInterior, kRemoved };

/// Del S of a point set with the complexes restricted to an oracle's domain: a cell belongs to Del|O if its label, that
/// of its circumcentre, is not 0, a facet to the surface if its dual edge is bipolar, that is, if the labels of its two
/// cells differ. Cells with a corner vertex are outside. Surface balls are computed on demand only (the lazy strategy
/// of the book, 14.1.3) and kept until their facet changes.
class RestrictedDelaunay {
 public:
  /// The number that stands for all beyond the corners, of label 0; it has no vertices.
  static constexpr CellId kBeyond = Delaunay3::kOutside;

  explicit RestrictedDelaunay(const Oracle& oracle);

  /// Inserts points of the surface in spatial order; all cells count as created. go_on() is asked now and then, so that
  /// it may throw; what it says is not heeded: with fewer seeds there would be components without any. Returns their
  /// vertices, kNone for points that are there already.
  std::vector<VertexId> insert_seeds(const std::vector<Point3>& seeds, const GoOn& go_on = always_go_on);

  /// Inserts points inside the domain that lie in no computed surface ball and on no vertex, in spatial order: many at
  /// once, labels being asked for at the end only. Ends early when go_on() says so. Returns their vertices, kNone for
  /// points not inserted; created() holds all cells made.
  std::vector<VertexId> insert_interior(const std::vector<Point3>& points, const GoOn& go_on);

  /// Puts tets inside the domain that are known in place of what their walls enclose. created() holds those at walls:
  /// facets between others are taken not to be bipolar. Returns the stamp of all of these tets; none, and nothing is
  /// changed, if one of the walls is no facet.
  std::optional<std::uint32_t> replace(const KnownTets& known);

  std::size_t cell_capacity() const { return delaunay_.cell_capacity(); }
  std::size_t vertex_capacity() const { return delaunay_.vertex_capacity(); }
  /// Vertices other than the corners.
  std::size_t vertex_count() const { return delaunay_.vertex_count() - Delaunay3::kCorners; }
  /// Changes whenever the number is given to another cell; 0: not in use.
  std::uint32_t stamp(CellId cell) const { return delaunay_.stamp(cell); }
  /// Cells made from now on have this stamp or a greater one.
  std::uint32_t next_stamp() const { return delaunay_.next_stamp(); }
  bool alive(CellId cell, std::uint32_t stamp) const { return delaunay_.stamp(cell) == stamp; }
  const Circumsphere& sphere(CellId cell) const { return delaunay_.sphere(cell); }
  Label label(CellId cell) const { return labels_[cell]; }
  /// In positive order; cells with corner vertices included.
  const std::array<VertexId, 4>& vertices(CellId cell) const { return delaunay_.vertices(cell); }
  /// Counter-clockwise seen from outside the cell.
  std::array<VertexId, 3> vertices(FacetId facet) const { return delaunay_.vertices(facet); }
  const std::array<CellId, 4>& neighbors(CellId cell) const { return delaunay_.neighbors(cell); }
  FacetId mirror(FacetId facet) const { return delaunay_.mirror(facet); }
  VertexKind kind(VertexId vertex) const { return kinds_[vertex]; }
  const Point3& point(VertexId vertex) const { return delaunay_.point(vertex); }
  /// Cells around a vertex, in an order that depends on the triangulation alone. Valid until the same thread asks again.
  const std::vector<CellId>& incident_cells(VertexId vertex) const;
  /// Some cell at the vertex.
  CellId cell_of(VertexId vertex) const { return delaunay_.cell_of(vertex); }
  /// A cell in use, if possible near the last change.
  CellId some_cell() const {
    const auto living = std::find_if(created_.begin(), created_.end(), [this](CellId cell) { return stamp(cell) != 0; });
    return living != created_.end() ? *living : cell_of(0);
  }
  /// Tells the processor that a cell, its label and its balls will be asked for soon.
  void prefetch(CellId cell) const {
    delaunay_.prefetch(cell);
    labels_.prefetch(cell);
    balls_.prefetch(cell);
  }
  void prefetch_vertex(VertexId vertex) const { delaunay_.prefetch_vertex(vertex); }
  void prefetch_balls(CellId cell) const { balls_.prefetch_balls(cell); }
  /// As prefetch_neighbors(), of their labels.
  void prefetch_labels_around(CellId cell) const {
    for (CellId neighbor : delaunay_.neighbors(cell)) labels_.prefetch(neighbor);
  }
  void prefetch_neighbors(CellId cell) const { delaunay_.prefetch_neighbors(cell); }
  /// The cell that contains p, by a walk from `hint`.
  CellId locate(const Point3& p, CellId hint) const { return delaunay_.locate(p, hint); }
  /// Tells the processor that what a walk asks of a cell's vertices will be asked for soon.
  void prefetch_vertices(CellId cell) const {
    for (VertexId vertex : delaunay_.vertices(cell)) delaunay_.prefetch_vertex(vertex);
  }

  /// Is the facet's dual edge bipolar?
  bool bipolar(FacetId facet) const { return label(facet.cell) != label(neighbors(facet.cell)[facet.index]); }
  /// The ball if it has been computed, else nullptr. Only bipolar facets have one.
  const SurfaceBall* ball(FacetId facet) const { return balls_.find(facet); }
  /// Whether any facet of the cell has a computed ball.
  bool has_balls(CellId cell) const { return balls_.any(cell); }
  /// Frees what balls take: none is asked for any more.
  void retire_balls() {
    balls_.retire();
    lane_.balls = {};
  }
  /// Computes and keeps the surface Delaunay ball. pre: bipolar(facet).
  const SurfaceBall& compute_ball(FacetId facet);
  /// A crossing of the dual edge between two Voronoi vertices of different labels; the same from both sides.
  Point3 dual_crossing(const Point3& center_a, Label label_a, const Point3& center_b, Label label_b) const {
    return dual_crossing(center_a, label_a, center_b, label_b, oracle_);
  }
  static Point3 dual_crossing(const Point3& center_a, Label label_a, const Point3& center_b, Label label_b,
                              const Oracle& oracle) {
    return label_a < label_b ? oracle.intersect(center_a, center_b) : oracle.intersect(center_b, center_a);
  }
  /// Is it a facet of Del S, that is, without corners?
  bool proper(FacetId facet) const;
  /// Every crossing of the facet's dual edge, whatever its labels, in an order that is the same from both sides.
  std::vector<Point3> dual_crossings(FacetId facet, const Oracle& oracle) const;
  /// The facet's surface Delaunay ball, computed anew and not kept. pre: bipolar(facet).
  SurfaceBall find_ball(FacetId facet, const Oracle& oracle) const;

  /// What would inserting p do? `hint` is a cell near p. The reference is valid until the next call.
  const Star& evaluate(const Point3& p, CellId hint);
  /// The star evaluated last.
  const Star& star() const { return lane_.star; }
  /// Inserts the apex of the star evaluated last; created() holds the new cells. pre: !star.duplicate.
  VertexId commit(VertexKind kind);
  /// Removes an interior vertex; created() holds the cells that fill the hole.
  void remove(VertexId vertex);
  /// Triangles whose balls the last insert_interior, replace, commit or remove dropped, or that became bipolar with
  /// the ball they had.
  const std::vector<std::array<VertexId, 3>>& lost() const { return lane_.lost; }
  /// Cells made by the last insert_seeds, insert_interior, replace, commit or remove.
  const std::vector<CellId>& created() const { return created_; }

  // Insertions in lanes. First, beside each other: evaluate and claim; then, by one thread: furnish; then, beside each
  // other: what holds its claims may be committed. Nothing else may change the triangulation meanwhile.

  /// The threads that work in lanes, and in all loops meanwhile.
  Team& team() { return team_; }
  /// The calling thread's own.
  Worker& worker() const { return workers_.local(); }
  void evaluate(const Point3& p, CellId hint, Worker& worker, Star& star) const;
  /// In two halves, as Delaunay3 does.
  void find_zone(const Point3& p, CellId hint, Worker& worker, Star& star) const {
    delaunay_.find_zone(p, hint, star, worker.search);
  }
  void find_tets(Worker& worker, Star& star) const;
  static constexpr std::size_t kMostLanes = Delaunay3::kMostClaims;
  std::uint32_t new_claims() { return delaunay_.new_claims(); }
  std::uint32_t new_claim() { return delaunay_.new_claim(); }
  void claim(const Lane& lane) const;
  bool holds(const Lane& lane) const { return delaunay_.holds(lane.star, lane.claim); }
  /// Of a facet, which may be gone by the time that this is asked: its vertices. pre: none is a far corner.
  void claim(const std::array<VertexId, 3>& triangle, std::uint32_t claim) const;
  bool holds(const std::array<VertexId, 3>& triangle, std::uint32_t claim) const;
  /// For the lane's star, if `star`, and so many new balls; with spare cells for the lane's next stars, so that these
  /// lie together in memory.
  void furnish(Lane& lane, bool star, std::size_t balls);
  /// Gives back what the lane has not used.
  void clear_out(Lane& lane);
  /// pre: holds(lane), furnished.
  VertexId commit(Lane& lane, VertexKind kind);
  /// Keeps a ball. pre: its vertices are held, furnished.
  void keep_ball(FacetId facet, const SurfaceBall& ball, Lane& lane);

 private:
  std::vector<FacetId> balls_without_crossing(const std::vector<CellId>& cells) const;
  Label label_of(const std::array<VertexId, 4>& vertices, const Circumsphere& sphere, const Oracle& oracle) const;
  void grow();
  void set_label(CellId cell, Label label);
  void describe(CellId cell, const Oracle& oracle);
  void give_back_room();
  std::vector<CellId> describe_since(std::uint32_t first_stamp);
  std::vector<VertexId> insert_all(const std::vector<Point3>& points, VertexKind kind, const GoOn& go_on);
  VertexId commit_unlabelled(Lane& lane, VertexKind kind);
  void lose_ball(FacetId facet, Lane& lane);

  const Oracle& oracle_;
  mutable PerThread<Worker> workers_;
  Team team_{thread_count()};
  Delaunay3 delaunay_;
  std::vector<VertexKind> kinds_;
  PageArray<std::uint16_t> labels_;
  SurfaceBalls balls_;
  std::vector<CellId> created_, destroyed_;
  Lane lane_;  // for insertions one by one
};

}  // namespace delvox
