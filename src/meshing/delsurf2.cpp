#include "delvox/meshing/delsurf2.h"

#include <cmath>
#include <deque>

#include "delvox/core/errors.h"
#include "meshing/check_options.h"
#include "meshing/extract.h"
#include "meshing/run_budget.h"
#include "meshing/surface_verdict.h"
#include "meshing/topological_balls.h"
#include "meshing/voronoi_faces.h"

namespace delvox {
namespace {

/// Vor S under refinement, and those of its faces that have not been looked at since they came to be: see
/// topological_balls.h why none needs to be looked at twice.
class TopologyDrivenRefinement {
 public:
  TopologyDrivenRefinement(SurfaceCover& cover, const CertifiedOracle& oracle, const SurfaceCriteria& surface,
                           RunBudget& budget, RunReport& report)
      : oracle_(oracle),
        surface_(surface),
        report_(report),
        budget_(budget),
        delaunay_(oracle),
        balls_(delaunay_, cover, oracle),
        closest_(1e-8 * cover.box().diagonal()) {}

  void insert_seeds();
  std::optional<Point3> find_violation();
  std::optional<Point3> find_bad_triangle();
  /// False if that cannot be done: x is on a vertex.
  bool insert(const Point3& x);
  void report_unmet();

  const RestrictedDelaunay& delaunay() const { return delaunay_; }

 private:
  /// A triangle of Del S, dual to a Voronoi edge.
  struct Triangle {
    FacetId facet;
    std::uint32_t stamp;
  };
  /// An edge of Del S, dual to a Voronoi facet.
  struct Edge {
    VertexId p, q;
  };

  template <class Face, class Diagnose>
  std::optional<Point3> first_in(std::deque<Face>& faces, const Diagnose& diagnose);
  std::optional<Point3> split_point(FacetId sigma);
  bool real(const Triangle& triangle) const;
  void watch(CellId cell);
  void watch_disk(VertexId p);

  const CertifiedOracle& oracle_;
  const SurfaceCriteria& surface_;
  RunReport& report_;
  RunBudget& budget_;
  RestrictedDelaunay delaunay_;
  TopologicalBalls balls_;
  double closest_;  ///< vertices do not come closer to each other
  std::deque<Triangle> voronoi_edges_, triangles_;
  std::deque<Edge> voronoi_facets_;
  std::deque<VertexId> disks_, voronoi_cells_;
  std::vector<std::uint8_t> disk_waits_;
  std::size_t stuck_ = 0, too_deviant_ = 0;
  Point3 stuck_place_, deviant_place_;
};

void TopologyDrivenRefinement::insert_seeds() {
  delaunay_.insert_seeds(oracle_.seeds(surface_.size, always_go_on).points);
  for (CellId cell : delaunay_.created()) watch(cell);
  for (VertexId p = 0; p < delaunay_.vertex_capacity(); ++p) {
    if (delaunay_.kind(p) != VertexKind::kSurface) continue;
    watch_disk(p);
    voronoi_cells_.push_back(p);
    for (VertexId q : voronoi_neighbors(delaunay_, p)) {
      if (p < q) voronoi_facets_.push_back({p, q});
    }
  }
}

/// Step 2.
std::optional<Point3> TopologyDrivenRefinement::find_violation() {
  const auto edge = [this](const Triangle& e) { return real(e) ? balls_.vor_edge(e.facet) : std::nullopt; };
  const auto disk = [this](VertexId p) {
    disk_waits_[p] = 0;
    const auto x = balls_.topo_disk(p);
    disk_waits_[p] = x.has_value();
    return x;
  };
  const auto facet = [this](const Edge& g) { return balls_.vor_facet(g.p, g.q); };
  const auto cell = [this](VertexId p) { return balls_.silhouette(p); };
  if (const auto x = first_in(voronoi_edges_, edge)) return x;    // (a)
  if (const auto x = first_in(disks_, disk)) return x;            // (b)
  if (const auto x = first_in(voronoi_facets_, facet)) return x;  // (c)
  return first_in(voronoi_cells_, cell);                          // (d)
}

/// Section 14.4.
std::optional<Point3> TopologyDrivenRefinement::find_bad_triangle() {
  return first_in(triangles_, [this](const Triangle& sigma) {
    return real(sigma) && delaunay_.bipolar(sigma.facet) ? split_point(sigma.facet) : std::nullopt;
  });
}

/// What is diagnosed with a point stays: something may be left of it once that is inserted.
template <class Face, class Diagnose>
std::optional<Point3> TopologyDrivenRefinement::first_in(std::deque<Face>& faces, const Diagnose& diagnose) {
  while (!faces.empty()) {
    if (!budget_.go_on_now(delaunay_.vertex_count(), faces.size())) return std::nullopt;
    if (const auto x = diagnose(faces.front())) return x;
    faces.pop_front();
  }
  return std::nullopt;
}

std::optional<Point3> TopologyDrivenRefinement::split_point(FacetId sigma) {
  const SurfaceBall* known = delaunay_.ball(sigma);
  const SurfaceBall ball = known != nullptr ? *known : delaunay_.compute_ball(sigma);
  const auto v = delaunay_.vertices(sigma);
  switch (judge(surface_, delaunay_.point(v[0]), delaunay_.point(v[1]), delaunay_.point(v[2]), ball)) {
    case SurfaceVerdict::kGood: return std::nullopt;
    case SurfaceVerdict::kSplit: return ball.center;
    case SurfaceVerdict::kTooDeviant: break;
  }
  ++too_deviant_;
  deviant_place_ = ball.center;
  return std::nullopt;
}

/// Still there, and dual to a Voronoi edge of sites only: those of corners lie outside the box.
bool TopologyDrivenRefinement::real(const Triangle& triangle) const {
  if (!delaunay_.alive(triangle.facet.cell, triangle.stamp)) return false;
  const auto v = delaunay_.vertices(triangle.facet);
  return std::none_of(v.begin(), v.end(), [this](VertexId p) { return delaunay_.kind(p) == VertexKind::kCorner; });
}

void TopologyDrivenRefinement::watch(CellId cell) {
  const std::uint32_t stamp = delaunay_.stamp(cell);
  for (int i = 0; i < 4; ++i) {
    const Triangle triangle{{cell, i}, stamp};
    const CellId neighbor = delaunay_.neighbors(cell)[i];
    const bool met_from_there = delaunay_.stamp(neighbor) == stamp && neighbor < cell;
    if (met_from_there || !real(triangle)) continue;
    voronoi_edges_.push_back(triangle);
    triangles_.push_back(triangle);
  }
}

void TopologyDrivenRefinement::watch_disk(VertexId p) {
  if (delaunay_.kind(p) != VertexKind::kSurface) return;
  if (disk_waits_.size() <= p) disk_waits_.resize(delaunay_.vertex_capacity(), 0);
  if (std::exchange(disk_waits_[p], 1) == 0) disks_.push_back(p);
}

/// Step 3.
bool TopologyDrivenRefinement::insert(const Point3& x) {
  const Star& star = delaunay_.evaluate(x, delaunay_.some_cell());
  std::vector<VertexId> around;
  for (const Star::Corner& corner : star.corners) around.push_back(corner.vertex);
  const bool on_vertex = star.duplicate || std::any_of(around.begin(), around.end(), [&](VertexId q) {
                           return squared_distance(delaunay_.point(q), x) < closest_ * closest_;
                         });
  if (on_vertex) {
    ++stuck_;
    stuck_place_ = x;
    return false;
  }
  const VertexId p = delaunay_.commit(VertexKind::kSurface);
  for (CellId cell : delaunay_.created()) watch(cell);
  watch_disk(p);
  voronoi_cells_.push_back(p);
  for (VertexId q : around) {
    watch_disk(q);
    if (delaunay_.kind(q) == VertexKind::kSurface) voronoi_facets_.push_back({p, q});
  }
  return true;
}

void TopologyDrivenRefinement::report_unmet() {
  report_.unmet = balls_.unmet();
  if (stuck_ > 0) {
    report_.unmet.push_back({"topology", stuck_, stuck_place_, "a new point coincides with a vertex", true});
  }
  if (too_deviant_ > 0) {
    report_.unmet.push_back({"deviation", too_deviant_, deviant_place_, "not met at the smallest ball radius", false});
  }
}

}  // namespace

// DelSurf2(Sigma), book section 14.2.2, with Quality of 14.4.
SurfaceMesh delsurf2(const SmoothFunction& h, const Box3& box, const DelSurf2Options& options, RunReport& report) {
  check_criteria(options.surface);
  refuse_features(options.surface, "delsurf2");
  report = RunReport{};
  RunBudget budget(options.control, report);
  budget.begin_stage("cover");
  SurfaceCover cover(h, box, [&budget] { return budget.go_on(0, 0); });
  const CertifiedOracle oracle(cover);
  TopologyDrivenRefinement refinement(cover, oracle, options.surface, budget, report);

  budget.begin_stage("seeds");
  refinement.insert_seeds();  // step 1
  if (refinement.delaunay().vertex_count() == 0) throw NothingToMesh("the surface is empty");
  budget.begin_stage("topology");
  bool going = true;
  while (going) {
    if (const auto x = refinement.find_violation()) {  // step 2
      going = refinement.insert(*x);                   // step 3
      ++report.topology_insertions;
    } else if (const auto c = refinement.find_bad_triangle()) {
      going = refinement.insert(*c);
      ++report.surface_insertions;
    } else {
      going = false;
    }
  }
  budget.end_stage();

  refinement.report_unmet();
  SurfaceMesh mesh = extract_surface(refinement.delaunay());  // step 4
  mesh.info.promises = promises_of(options.surface);
  withdraw_unmet(report, mesh.info.promises);
  mesh.info.complete = report.succeeded();
  return mesh;
}

SurfaceMesh delsurf2(const SmoothDomain& domain, const DelSurf2Options& options, RunReport& report) {
  DelSurf2Options local = options;
  if (const SizeField& size = options.surface.size; !size.constant()) {
    local.surface.size = SizeField([&](const Point3& p) { return size(domain.to_world(p)); }, size.minimum(),
                                   size.maximum());
  }
  SurfaceMesh mesh = delsurf2(*domain.function, domain.box, local, report);
  for (Point3& p : mesh.points) p = domain.to_world(p);
  for (Unmet& unmet : report.unmet) {
    if (unmet.where) unmet.where = domain.to_world(*unmet.where);
  }
  if (domain.to_world.determinant() < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

}  // namespace delvox
