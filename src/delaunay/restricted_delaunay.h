#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "delaunay/circumsphere.h"
#include "delaunay/ids.h"
#include "delvox/core/geometry.h"
#include "delvox/oracle/oracle.h"

namespace delvox {

enum class VertexKind : std::uint8_t { kCorner, kSurface, kInterior };

/// A circumball of a restricted triangle, centred on the surface (book, definition 14.1).
struct SurfaceBall {
  Point3 center;
  double squared_radius = 0;
};

/// What Del S knows of a cell beside its vertices: its Voronoi vertex and the region that lies in. One cache line.
struct alignas(64) Cell {
  Circumsphere sphere;
  Label label = 0;          ///< of the circumcentre; cells with a corner vertex are outside
  std::uint32_t stamp = 0;  ///< changes whenever the number is given to another cell; 0: not in use
  std::array<std::int32_t, 4> balls{-1, -1, -1, -1};  ///< number of each facet's surface ball, -1: none computed
  mutable std::uint32_t visited = 0;                  ///< epoch of the last search that met the cell
};

/// The tetrahedra that inserting a point would make, known before anything is changed.
struct Star {
  struct Tet {
    FacetId outer;                    ///< facet of the cell that will be its neighbour opposite the apex
    std::array<VertexId, 3> vertices;  ///< the other three; (apex, vertices) is positive
    Circumsphere sphere;
    Label label = 0;
  };
  Point3 apex;
  bool duplicate = false;        ///< the apex is a vertex already; zone and tets are empty
  std::vector<CellId> zone;      ///< cells whose circumsphere contains the apex
  std::vector<Tet> tets;
};

/// Del S of a point set with the complexes restricted to an oracle's domain: a cell belongs to Del|O if its label is
/// not 0, a facet to the surface if its dual edge is bipolar, that is, if the labels of its two cells differ. Surface
/// balls are computed on demand only (the lazy strategy of the book, 14.1.3) and kept until their facet changes.
class RestrictedDelaunay {
 public:
  explicit RestrictedDelaunay(const Oracle& oracle);
  ~RestrictedDelaunay();

  /// Inserts points of the surface in spatial order; all cells count as created.
  void insert_seeds(const std::vector<Point3>& seeds);

  std::size_t cell_capacity() const { return cells_.size(); }
  std::size_t vertex_capacity() const { return kinds_.size(); }
  /// Vertices other than the corners.
  std::size_t vertex_count() const;
  bool alive(CellId cell, std::uint32_t stamp) const { return cells_[cell].stamp == stamp; }
  const Cell& cell(CellId cell) const { return cells_[cell]; }
  /// In positive order; cells with corner vertices included.
  const std::array<VertexId, 4>& vertices(CellId cell) const;
  /// Counter-clockwise seen from outside the cell.
  std::array<VertexId, 3> vertices(FacetId facet) const;
  const std::array<CellId, 4>& neighbors(CellId cell) const;
  FacetId mirror(FacetId facet) const;
  VertexKind kind(VertexId vertex) const { return kinds_[vertex]; }
  const Point3& point(VertexId vertex) const { return points_[vertex]; }
  /// Cells around a vertex, in an order that depends on the triangulation alone. Valid until the next call.
  const std::vector<CellId>& incident_cells(VertexId vertex) const;
  /// The cell that contains p, by a walk from `hint`.
  CellId locate(const Point3& p, CellId hint) const;

  /// Is the facet's dual edge bipolar?
  bool bipolar(FacetId facet) const;
  /// The ball if it has been computed, else nullptr. Only bipolar facets have one.
  const SurfaceBall* ball(FacetId facet) const;
  /// Computes and keeps the surface Delaunay ball. pre: bipolar(facet).
  const SurfaceBall& compute_ball(FacetId facet);
  /// A crossing of the dual edge between two Voronoi vertices of different labels; the same from both sides.
  Point3 dual_crossing(const Point3& center_a, Label label_a, const Point3& center_b, Label label_b) const;

  /// What would inserting p do? `hint` is a cell near p. The reference is valid until the next call.
  const Star& evaluate(const Point3& p, CellId hint);
  /// Inserts the apex of the star evaluated last; created() holds the new cells. pre: !star.duplicate.
  VertexId commit(VertexKind kind);
  /// Removes an interior vertex; created() holds the cells that fill the hole.
  void remove(VertexId vertex);
  /// Cells made by the last insert_seeds, commit or remove.
  const std::vector<CellId>& created() const { return created_; }

 private:
  struct Kernel;

  void find_zone(const Point3& p, CellId start);
  bool in_conflict(CellId cell, const Point3& p) const;
  void collect_star_tets();
  Star::Tet make_star_tet(FacetId inner) const;
  void describe_cell(CellId cell);
  void drop_ball(FacetId facet);
  void drop_balls_of(CellId cell);
  void set_ball(FacetId facet, std::int32_t ball);
  void ensure_cell(CellId cell);
  void name_vertex(VertexId vertex, const Point3& p, VertexKind kind);

  const Oracle& oracle_;
  std::unique_ptr<Kernel> kernel_;
  std::vector<Cell> cells_;
  std::vector<Point3> points_;
  std::vector<VertexKind> kinds_;
  std::vector<SurfaceBall> balls_;
  std::vector<std::int32_t> free_balls_;
  std::vector<CellId> created_, destroyed_;
  mutable std::vector<CellId> around_;
  Star star_;
  std::vector<FacetId> inner_facets_;
  double trusted_squared_radius_ = 0;
  mutable std::uint32_t epoch_ = 0;
  std::uint32_t next_stamp_ = 1;
};

}  // namespace delvox
