#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/restricted_delaunay.h"
#include "delvox/core/run.h"
#include "delvox/meshing/criteria.h"
#include "delvox/meshing/variant.h"
#include "delvox/oracle/oracle.h"
#include "meshing/feature_segments.h"
#include "meshing/landmark_watch.h"
#include "meshing/persistent_triangle.h"
#include "meshing/pieces.h"
#include "meshing/refinement_lane.h"
#include "meshing/repair_effort.h"
#include "meshing/run_budget.h"
#include "meshing/surface_triangulation.h"

namespace delvox {

class InteriorLattice;
struct Fold;

/// Del S under refinement with its lazy queues (book, 14.1.3): facets that may be restricted, vertices whose umbrella
/// may have changed, and, once watched, tetrahedra that break a criterion. Refinement works in lanes: it treats many
/// entries at a time, spread over the mesh, by as many threads as there are; what comes out does not depend on these.
class Refinement {
 public:
  Refinement(const Oracle& oracle, const SurfaceCriteria& surface, const RunControl& control, const Variant& variant,
             RunReport& report);

  /// Sharp edges of the domain are to be kept, if the criteria say so, in segments shorter than `longest`; `solid`:
  /// of tets. Throws OptionError if the domain can have none. To be called before start().
  void keep_features(double longest, bool solid);
  /// Step 1: seeds on every component, or a persistent triangle on each. Throws NothingToMesh if there is no surface.
  void start();

  /// Step 1 with a sample that an earlier run has made, in place of seeds. pre: that was of the same surface.
  void start_with(const std::vector<Point3>& sample);
  /// From now on, restricted triangles that are to be split are left as they are where the sample is dense. Seeds will be
  /// fewer.
  void leave_dense() { leaves_dense_ = true; }
  /// The share of restricted triangles where the sample is not dense.
  double rough_share() const;
  /// Adds points of the surface to the sample; what cannot be, as it is there already, is left out.
  void insert_more(const std::vector<Point3>& points);
  /// Del|Sigma without Del S; none if it is no closed 2-manifold. pre: no triangle waits.
  std::optional<SurfaceTriangulation> surface_triangulation() const;

  /// Works the queues until nothing waits, or the budget is used up. Steps 2 to 4 of DelTetSurf with Quality and the
  /// deviation bound: removes interior vertices from the surface, and splits restricted triangles that are too large,
  /// too skinny, or have one label on both sides. Step 7, once tetrahedra are watched and while no triangle waits:
  /// splits those that break a criterion.
  void refine();
  /// If there is no triangle to refine, though the surface is there: inserts what makes one, for each component if it
  /// has a persistent triangle. True if anything was inserted.
  bool mend_inadequate();
  /// Step 5, then sharp edges, then landmarks; neither once step 5 has turned out to be hopeless. Before that, mend_inadequate().
  /// True if anything was inserted.
  bool repair() {
    return mend_inadequate() ||
           (!effort_.hopeless() && (repair_topology() || repair_features() || repair_landmarks()));
  }
  /// Step 4 of DelSurf, step 6 of DelTetSurf: one vertex of each persistent triangle that has more than one; once none
  /// has, Quality begins. False if there was nothing left to do.
  bool delete_persistent_vertex();
  /// Smooth (book, 14.4): splits triangles at edges that are too rough, returning to step 2 after each insertion. True
  /// if anything was inserted: step 3 must look again.
  bool smooth();
  /// Not in the book: one insertion for each fold of the surface that is sharper than the bound, until its balls are
  /// the smallest; none once step 5 has turned out to be hopeless, or where there are landmarks. True if anything was
  /// inserted.
  bool repair_folds(double min_fold_degrees);

  /// Fills the inside with a lattice where a constant bound on circumradii leaves room for one.
  void fill_interior(const TetCriteria& criteria);
  /// From now on tetrahedra that break `criteria` are kept in a stack.
  void watch_tets(const TetCriteria& criteria);

  /// Tells the report what could not be met.
  void report_unmet();
  /// Frees what the mesh is not made of, before it is copied out: queues, landmarks, surface balls.
  void retire();

  const RestrictedDelaunay& delaunay() const { return delaunay_; }
  /// The edges that follow sharp edges of the domain.
  std::vector<std::array<VertexId, 2>> feature_edges() const;
  RunBudget& budget() { return budget_; }

 private:
  struct LandmarkPlace {
    CellId cell = kNone;
    std::uint32_t stamp = 0;
    bool lost = false;  ///< on the wrong side, and nothing can be inserted for it
  };
  /// A cell that must go, and a crossing inside its sphere to insert for it.
  struct MisplacedCell {
    Point3 crossing;
    CellId cell;
    std::uint32_t stamp;
  };
  /// A surface ball, and a cell near its centre.
  struct PlacedBall {
    SurfaceBall ball;
    CellId near = kNone;
  };
  /// A matter of the mesh alone, never of the number of threads.
  static constexpr std::size_t kLanes = 16;
  static_assert(kLanes <= RestrictedDelaunay::kMostLanes);
  /// kTwoFaced: faces inside or outside with both sides, and its ball is too small to be split.
  enum class Verdict { kGood, kSplit, kTooDeviant, kTwoFaced };
  /// Of one component; vertices that are not there are kNone.
  struct PersistentTriangle {
    std::vector<Point3> seeds;  ///< of the component
    std::array<Point3, 3> points;
    std::array<VertexId, 3> vertices{kNone, kNone, kNone};
    int helped = 0;  ///< how often refinement was stuck without
  };

  // Lanes (refinement_lanes.cpp)
  static bool enough_for_lanes(std::size_t waiting);
  void run_lanes(RefinementQueues& aside);
  void run_rounds(const std::function<void(RefinementLane&)>& look,
                  const std::function<bool(const RefinementLane&)>& has_work);
  void run_round(const std::function<void(RefinementLane&)>& look);
  void place_vertices();
  void sort_by_place();
  void keep_to_budget();
  void run_alone(std::size_t at_least);
  void furnish(RefinementLane& lane);
  void collect(RefinementLane& lane);
  void look(RefinementLane& lane, RefinementQueues& queues, bool alone);
  void add_judged(RefinementLane& lane, const RefinementQueues::WaitingFacet& waiting, const SurfaceBall& ball,
                  bool too_deviant) const;
  void claim(RefinementLane& lane);
  void prefetch_ahead(const RefinementQueues& queues) const;
  bool look_at_facet(RefinementLane& lane, RefinementQueues& queues, Worker& worker, bool alone);
  void conclude(RefinementLane& lane, RefinementQueues& queues);
  void judge_new(RefinementLane& lane, RefinementQueues& queues, std::size_t first);
  void keep(RefinementLane& lane, FacetId facet, const SurfaceBall& ball, bool too_deviant);

  // Surface (surface_refinement.cpp)
  /// What asks for work in cells that have been created, along with others of which the oldest has that stamp. Asked by
  /// several threads.
  void enqueue(std::span<const CellId> created, std::uint32_t oldest, RefinementQueues& queues) const;
  std::uint32_t oldest_stamp(const std::vector<CellId>& created) const;
  void enqueue_created();
  bool has_interior_vertex(FacetId facet) const;
  void remove_interior_vertex_of(FacetId facet);
  void remove_vertex(VertexId vertex);
  /// Whether the facet's dual edge must be looked at to know if the facet is restricted.
  bool may_be_restricted(FacetId facet) const {
    return delaunay_.bipolar(facet) || (variant_.restricted == Restricted::kAll && delaunay_.proper(facet));
  }
  std::optional<SurfaceBall> find_ball(FacetId facet, const Oracle& oracle) const;
  Verdict judge(FacetId facet, const SurfaceBall& ball) const;
  std::optional<VertexId> insert_surface_point(const Point3& p, CellId hint);
  std::optional<VertexId> insert_on_surface(const Point3& p, CellId hint);
  std::optional<VertexId> insert_apex_on_surface();
  std::optional<VertexId> insert_apex();
  void mark_dirty(const std::array<VertexId, 3>& triangle);
  void mark_dirty(VertexId vertex);
  /// Umbrellas change only where triangles lose their balls or get new ones.
  void mark_lost_dirty();

  // Umbrellas (umbrella_repair.cpp)
  /// Step 5: one insertion for each vertex whose triangles are no topological disk. True if anything was inserted.
  bool repair_topology();
  bool repair_deferred_umbrellas();
  bool repair_umbrellas(std::vector<VertexId> waiting, bool may_defer);
  void run_umbrella_lanes(std::vector<VertexId>& waiting, std::vector<VertexId>& aside, bool may_defer);
  void look_at_umbrellas(RefinementLane& lane, bool may_defer);
  PlacedBall ball_to_split(VertexId vertex, RefinementLane& lane, bool may_defer) const;
  void split_feature_for(VertexId vertex, bool may_defer);
  void count_umbrella(double split_radius);
  void collect_umbrellas(RefinementLane& lane);

  // Sharp edges (feature_refinement.cpp)
  enum class AtFeature { kClear, kLeave, kSplit };
  void insert_seeds_beside_features(const Seeds& seeds, const GoOn& go_on);
  void note_node(std::uint32_t node, VertexId vertex);
  std::uint32_t node_of(VertexId vertex) const {
    return vertex < node_of_vertex_.size() ? node_of_vertex_[vertex] : kNone;
  }
  /// Whether a facet or cell has a vertex on a sharp edge.
  template <class Simplex>
  bool touches_feature(Simplex simplex) const {
    if (!features_) return false;
    const auto& vertices = delaunay_.vertices(simplex);
    return std::any_of(vertices.begin(), vertices.end(), [this](VertexId v) { return node_of(v) != kNone; });
  }
  bool kept_edge(FacetId one, FacetId other) const;
  AtFeature at_feature(const Point3& p, bool exempt, std::uint32_t& segment) const;
  std::optional<VertexId> split_feature(std::uint32_t segment);
  bool covered(std::uint32_t segment) const;
  bool repair_features();
  bool repair_feature(std::uint32_t segment);

  // Repair (landmark_repair.cpp)
  /// For meshes fine enough that the oracle has landmarks: one insertion for each landmark on the wrong side of the
  /// mesh; if there is none, for each link that does not stay on its side; if there is none, step 5 where it waited for
  /// these; if there is none, for each Voronoi edge that makes an excursion to the other side; if there is none, for each
  /// piece without a landmark. True if anything was inserted. All but umbrellas and Voronoi edges is not in the book:
  /// trilinear surfaces have necks and gaps of any width, which no size field foresees.
  bool repair_landmarks();

  // Folds (fold_repair.cpp)
  bool split_fold(const Fold& fold);

  // Persistent triangles, and what else keeps refinement from being stuck (persistent_start.cpp)
  static bool stays(const PersistentTriangle& triangle);
  bool shapes_matter() const { return persistent_.empty() || persistent_gone_; }
  void insert_persistent_triangles(const Seeds& seeds);
  bool choose_persistent(PersistentTriangle& triangle);
  void insert_persistent(PersistentTriangle& triangle);
  bool reinsert(PersistentTriangle& triangle);
  bool replace(PersistentTriangle& triangle);
  bool has_triangle(VertexId vertex) const;
  bool has_any_triangle() const;
  std::vector<VertexId> surface_vertices() const;
  bool split_largest_ball_at(std::span<const VertexId> vertices);

  // Smooth (smooth.cpp)
  bool wants_smooth() const { return surface_.max_roughness_degrees < 180 && !effort_.hopeless(); }
  std::optional<FacetId> facet_to_smooth(VertexId vertex) const;
  void report_roughness();

  // Landmarks (landmark_repair.cpp)
  std::vector<LandmarkWatch::Due> find_misplaced(const std::vector<LandmarkWatch::Due>& due);
  CellId cell_of_landmark(const LandmarkWatch::Due& due, CellId hint) const;
  bool repair_landmark(const LandmarkWatch::Due& due);
  std::optional<Point3> crossing_beside(const Point3& landmark, CellId cell, const Oracle& oracle) const;
  bool insert_for_landmark(const Point3& p, CellId hint);
  bool repair_links();
  void follow_links(std::span<const std::uint32_t> links, std::vector<MisplacedCell>& misplaced) const;
  bool insert_where_misplaced(const std::vector<MisplacedCell>& misplaced);
  bool repair_pieces();
  std::vector<SurfaceBall> largest_balls(Pieces& pieces, const std::vector<bool>& real) const;
  Box3 box_of_change(const Star& star) const;
  void note_change(const Box3& box, VertexId near);
  void note_new_facets();
  std::size_t vertex_count() const { return delaunay_.vertex_count(); }
  bool budget_left() { return budget_.go_on(vertex_count(), queues_.waiting()); }

  // Voronoi edges (voronoi_edges.cpp)
  bool repair_voronoi_edges(bool again);
  std::vector<MisplacedCell> excursions_of_all() const;
  std::vector<MisplacedCell> excursions_at(std::vector<VertexId> vertices) const;
  void add_excursions(CellId cell, VertexId at, const Oracle& oracle, std::vector<MisplacedCell>& misplaced) const;
  bool look_closer();
  SurfaceTopology topology();
  SurfaceTopology count_topology() const;
  std::optional<Point3> crossing_of_excursion(FacetId facet, const Oracle& oracle) const;

  // Lattice (lattice_filling.cpp)
  void insert_shell(InteriorLattice& lattice);

  // Tetrahedra (tet_refinement.cpp)
  bool bad(CellId cell) const;
  void look_at_tet(RefinementLane& lane, RefinementQueues& queues, Worker& worker, bool alone);
  std::optional<bool> leaves_to_features(const RefinementQueues::WaitingFacet& waiting, const SurfaceBall& ball,
                                         RefinementLane& lane, RefinementQueues& queues, bool alone);
  bool leaves_to_features(const RefinementQueues::WaitingTet& waiting, const Point3& p, RefinementLane& lane,
                          RefinementQueues& queues, bool alone);
  PlacedBall find_obstacle(const Point3& p, CellId cell, Worker& worker, Star& star) const;
  std::optional<Point3> point_aside(CellId cell, const SurfaceBall& ball, Worker& worker, Star& star) const;
  PlacedBall encroached_ball_beside(CellId cell, const Oracle& oracle) const;
  void find_encroached_ball(const Point3& z, std::span<const CellId> cells, const Oracle& oracle,
                            PlacedBall& largest) const;
  void find_new_ball(const Star& star, const Oracle& oracle, PlacedBall& largest) const;

  const Oracle& oracle_;
  SurfaceCriteria surface_;
  SurfaceCriteria touching_;  // what triangles that touch sharp edges are held to
  Variant variant_;
  const TetCriteria* tet_criteria_ = nullptr;
  std::uint32_t lattice_stamp_ = 0;  // of tets that meet any criteria, from the lattice inside
  RunReport& report_;
  RunBudget budget_;
  RestrictedDelaunay delaunay_;

  std::optional<FeatureSegments> features_;
  bool solid_ = false;
  std::vector<VertexId> vertex_of_node_;
  std::vector<std::uint32_t> node_of_vertex_;  // kNone: of none; sharp edges' vertices are never removed
  std::vector<std::uint32_t> uncovered_;  // segments given up
  std::uint32_t features_from_ = 0;  // the next stamp when all segments were last seen to be covered or given up

  RandomStream random_;
  std::vector<PersistentTriangle> persistent_;
  bool persistent_gone_ = false;
  bool leaves_dense_ = false;
  RefinementQueues queues_;
  std::vector<std::uint32_t> places_;  // of vertices along a curve
  std::array<RefinementLane, kLanes> lanes_;
  std::vector<VertexId> dirty_;
  std::vector<std::uint8_t> is_dirty_;
  LandmarkWatch watch_;
  std::vector<LandmarkPlace> landmark_places_;
  bool pieces_changed_ = true;
  bool edges_looked_at_ = false;
  std::vector<VertexId> since_edges_;  // vertices at which facets may be new since then
  double shortest_excursion_ = 0.1;  // of Voronoi edges that the mesh takes notice of, in sizes
  bool looks_closer_ = false;
  std::uint32_t folds_from_ = 0;  // cells with this stamp or a later one were not there when folds were looked for
  std::optional<SurfaceTopology> expected_topology_, topology_;
  std::uint32_t topology_from_ = 0;  // the next stamp when that was counted
  std::size_t vertices_at_first_look_ = 0, closer_insertions_ = 0;
  RepairEffort effort_;
  std::vector<VertexId> since_smooth_;  // vertices whose umbrella has changed since Smooth looked at it
  std::vector<VertexId> deferred_;      // umbrellas whose balls are so small that landmarks come first
  std::vector<VertexId> unrepaired_;    // umbrellas given up at the smallest ball radius
  std::vector<RefinementQueues::WaitingFacet> two_faced_;  // given up at the smallest ball radius
  std::size_t too_deviant_ = 0, stuck_ = 0, lost_landmarks_ = 0;
  Point3 deviant_place_, stuck_place_, lost_place_;
};

}  // namespace delvox
