#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "delaunay/restricted_triangles.h"
#include "delvox/core/errors.h"
#include "meshing/delsurf_steps.h"
#include "meshing/surface_verdict.h"

namespace delvox {

void Refinement::start_with(const std::vector<Point3>& sample) {
  const auto go_on = [this] { return budget_.go_on(vertex_count(), 0); };
  watch_ = LandmarkWatch(along_curve(oracle_.landmarks(surface_.size, go_on)));
  delaunay_.insert_seeds(sample, go_on);
  enqueue_created();
}

double Refinement::rough_share() const {
  constexpr std::size_t kChunk = 1024;
  const std::vector<FacetId> facets = restricted_triangles(delaunay_);
  const auto counts = map_chunks(facets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    const Oracle& oracle = *delaunay_.worker().oracle;
    return std::count_if(facets.begin() + static_cast<std::ptrdiff_t>(begin),
                         facets.begin() + static_cast<std::ptrdiff_t>(end), [&](FacetId facet) {
                           const auto v = delaunay_.vertices(facet);
                           return !dense_at(delaunay_.point(v[0]), delaunay_.point(v[1]), delaunay_.point(v[2]),
                                            delaunay_.find_ball(facet, oracle));
                         });
  });
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::ptrdiff_t{0})) /
         static_cast<double>(std::max<std::size_t>(facets.size(), 1));
}

void Refinement::insert_more(const std::vector<Point3>& points) {
  for (const Point3& p : points) {
    if (!budget_left()) return;
    if (delaunay_.evaluate(p, delaunay_.some_cell()).duplicate) continue;
    if (insert_surface_point(p, delaunay_.some_cell())) ++report_.surface_insertions;
  }
}

std::optional<SurfaceTriangulation> Refinement::surface_triangulation() const {
  std::vector<std::uint32_t> numbers(delaunay_.vertex_capacity(), kNone);
  std::vector<Point3> points;
  for (VertexId v = 0; v < numbers.size(); ++v) {
    if (delaunay_.kind(v) != VertexKind::kSurface) continue;
    numbers[v] = static_cast<std::uint32_t>(points.size());
    points.push_back(delaunay_.point(v));
  }
  const std::vector<FacetId> facets = restricted_triangles(delaunay_);
  std::vector<Triangle> triangles;
  std::vector<SurfaceBall> balls;
  triangles.reserve(facets.size());
  balls.reserve(facets.size());
  for (FacetId facet : facets) {
    const SurfaceBall* ball = delaunay_.ball(facet);
    if (ball == nullptr) return std::nullopt;  // a limit has left it unjudged
    const auto v = delaunay_.vertices(facet);
    triangles.push_back({numbers[v[0]], numbers[v[1]], numbers[v[2]]});
    balls.push_back(*ball);
  }
  return SurfaceTriangulation::make(std::move(points), triangles, balls);
}

namespace {

/// Exercise 3 of the book's chapter 14: the refinement of a dense sample without Del S.
class DenseRefinement {
 public:
  using TriangleId = SurfaceTriangulation::TriangleId;

  DenseRefinement(SurfaceTriangulation& surface, const Oracle& oracle, const SurfaceCriteria& criteria,
                  RunBudget& budget)
      : surface_(surface), oracle_(oracle), criteria_(criteria), budget_(budget) {}

  /// Splits what breaks a bound, until nothing does or the budget is used up. Where that cannot be done, or a ball is
  /// not empty, the sample is not dense enough, and is made denser; `failures` are the places where that did not help,
  /// and those of the probes that are in no ball. The latter are returned.
  std::vector<Point3> refine(const std::vector<Point3>& probes, std::size_t& failures);
  std::size_t insertions() const { return insertions_; }
  /// Counts the triangles that are too deviant, those that Del S has left included.
  void report_deviation(RunReport& report) const;

 private:
  struct Waiting {
    TriangleId triangle;
    std::uint32_t stamp;
  };

  SurfaceVerdict verdict(TriangleId t) const {
    return judge(criteria_, surface_.corner(t, 0), surface_.corner(t, 1), surface_.corner(t, 2), surface_.ball(t));
  }
  bool bad(TriangleId t) const { return verdict(t) == SurfaceVerdict::kSplit; }
  void split_bad();
  bool split_waiting();
  bool split_around_stuck();
  bool split_around(TriangleId t);
  bool split(TriangleId t);

  SurfaceTriangulation& surface_;
  const Oracle& oracle_;
  const SurfaceCriteria& criteria_;
  RunBudget& budget_;
  std::vector<Waiting> waiting_, stuck_;
  std::size_t insertions_ = 0;
};

std::vector<Point3> DenseRefinement::refine(const std::vector<Point3>& probes, std::size_t& failures) {
  constexpr int kMostLooks = 8;
  for (TriangleId t = 0; t < surface_.size(); ++t) {
    if (bad(t)) waiting_.push_back({t, surface_.stamp(t)});
  }
  split_bad();
  std::vector<Point3> uncovered;
  for (int look = 0; look < kMostLooks && !budget_.exhausted(); ++look) {
    budget_.begin_stage("balls");
    const auto found = surface_.look_into_balls(probes);
    failures = found.occupied.size() + found.uncovered.size() + stuck_.size();
    uncovered.clear();
    for (std::uint32_t i : found.uncovered) uncovered.push_back(probes[i]);
    if (found.occupied.empty() || !found.uncovered.empty() || !stuck_.empty()) break;
    budget_.begin_stage("dense");
    std::vector<Waiting> occupied;
    for (TriangleId t : found.occupied) occupied.push_back({t, surface_.stamp(t)});
    for (const auto& [t, stamp] : occupied) {
      if (surface_.stamp(t) == stamp && !split(t)) split_around(t);
    }
    split_bad();
  }
  return uncovered;
}

/// First in, first out. What is stuck may be split once there are new triangles around it.
void DenseRefinement::split_bad() {
  constexpr int kMostRounds = 8;
  for (int round = 0; split_waiting() && round < kMostRounds && split_around_stuck(); ++round) continue;
}

/// False if nothing is left.
bool DenseRefinement::split_waiting() {
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const auto [t, stamp] = waiting_[i];
    if (surface_.stamp(t) != stamp) continue;
    if (!budget_.go_on(surface_.points().size(), waiting_.size() - i)) break;
    if (!split(t)) stuck_.push_back({t, stamp});
  }
  waiting_.clear();
  std::erase_if(stuck_, [&](const Waiting& left) { return surface_.stamp(left.triangle) != left.stamp; });
  return !stuck_.empty() && !budget_.exhausted();
}

/// What is left of them waits again. False if that changed nothing.
bool DenseRefinement::split_around_stuck() {
  bool any = false;
  for (const auto& [t, stamp] : std::exchange(stuck_, {})) {
    if (surface_.stamp(t) != stamp) continue;
    waiting_.push_back({t, stamp});
    any |= split_around(t);
  }
  if (!any) stuck_.swap(waiting_);
  return any;
}

/// Makes the sample denser around a triangle: at one of its neighbours, or at one of theirs, the largest ball first.
bool DenseRefinement::split_around(TriangleId t) {
  std::vector<TriangleId> around;
  for (TriangleId neighbor : surface_.neighbors(t)) {
    around.push_back(neighbor);
    for (TriangleId next : surface_.neighbors(neighbor)) {
      if (next != t) around.push_back(next);
    }
  }
  const auto squared_radius = [&](TriangleId a) { return surface_.ball(a).squared_radius; };
  std::stable_sort(around.begin(), around.end(),
                   [&](TriangleId a, TriangleId b) { return squared_radius(a) > squared_radius(b); });
  return std::any_of(around.begin(), around.end(), [&](TriangleId a) { return split(a); });
}

/// The smallest balls are left alone: what a few splits do not mend is Del S's.
bool DenseRefinement::split(TriangleId t) {
  const double smallest = criteria_.min_ball_radius;
  if (surface_.ball(t).squared_radius <= smallest * smallest) return false;
  if (!surface_.insert_ball_center(t, oracle_)) return false;
  ++insertions_;
  for (TriangleId made : surface_.created()) {
    if (bad(made)) waiting_.push_back({made, surface_.stamp(made)});
  }
  return true;
}

void DenseRefinement::report_deviation(RunReport& report) const {
  Unmet unmet{"deviation", 0, {}, "not met at the smallest ball radius", false};
  for (TriangleId t = 0; t < surface_.size(); ++t) {
    if (verdict(t) != SurfaceVerdict::kTooDeviant) continue;
    ++unmet.count;
    unmet.where = surface_.ball(t).center;
  }
  std::erase_if(report.unmet, [&](const Unmet& known) { return known.criterion == unmet.criterion; });
  if (unmet.count > 0) report.unmet.push_back(unmet);
}

/// Of the vertices that have triangles.
SurfaceMesh mesh_of(const SurfaceTriangulation& surface) {
  SurfaceMesh mesh;
  mesh.triangles.reserve(surface.size());
  std::vector<std::uint32_t> numbers(surface.points().size(), kNone);
  for (std::uint32_t t = 0; t < surface.size(); ++t) mesh.triangles.push_back(surface.corners(t));
  for (const Triangle& triangle : mesh.triangles) {
    for (std::uint32_t v : triangle) numbers[v] = 0;
  }
  for (std::size_t v = 0; v < numbers.size(); ++v) {
    if (numbers[v] == kNone) continue;
    numbers[v] = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(surface.points()[v]);
  }
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = numbers[v];
  }
  return mesh;
}

/// DelSurf where it has to be, that is, with Del S: the topology, and what is to be split where the sample is not dense.
/// The rest is split without. In the end every ball is looked into: a triangle whose ball is empty is restricted
/// Delaunay, and they still form the 2-manifold they did. If something is in the way of that anywhere, Del S is made
/// again, of all vertices, and DelSurf goes on from there.
class DelSurfOnceDense {
 public:
  DelSurfOnceDense(const Oracle& oracle, const DelSurfOptions& options, RunReport& report)
      : oracle_(oracle), criteria_(options.surface), variant_(options.variant), control_(options.control), report_(report) {}

  SurfaceMesh run();

 private:
  using Clock = std::chrono::steady_clock;

  void begin_phase();
  void make_whole() {
    whole_.emplace(oracle_, criteria_, control_, variant_, report_);
    whole_->budget().begin_stage("seeds");
  }
  std::optional<SurfaceTriangulation> dense_sample();
  std::vector<Point3> take_uncovered_seeds(const SurfaceTriangulation& surface);
  void refine_dense(SurfaceTriangulation& surface);
  SurfaceMesh run_plain();
  SurfaceMesh finish_from(std::vector<Point3> sample);
  SurfaceMesh finish_whole() {
    refine_surface(*whole_);
    return finished_surface(*whole_, criteria_, report_);
  }

  const Oracle& oracle_;
  const SurfaceCriteria& criteria_;
  const Variant& variant_;
  RunControl control_;
  RunReport& report_;
  std::optional<Refinement> whole_;  // Del S
  std::vector<Point3> seeds_;        // that DelSurf would begin with
  std::vector<Point3> missed_;       // seeds that end in no ball
  Clock::time_point phase_start_ = Clock::now();
};

SurfaceMesh DelSurfOnceDense::run() {
  auto surface = dense_sample();
  if (report_.stop != StopReason::kFinished) return finished_surface(*whole_, criteria_, report_);
  whole_.reset();
  if (!surface) return run_plain();
  begin_phase();
  refine_dense(*surface);
  if (report_.dense_failures > 0) return finish_from(std::exchange(surface, std::nullopt)->points());
  SurfaceMesh mesh = mesh_of(*surface);
  promise(mesh, criteria_, report_);
  return mesh;
}

/// Each has a budget of its own: what earlier ones have left of the time.
void DelSurfOnceDense::begin_phase() {
  constexpr double kLeast = 1e-9;  // 0 is no limit
  double& seconds = control_.limits.max_seconds;
  const Clock::time_point now = Clock::now();
  const double spent = std::chrono::duration<double>(now - std::exchange(phase_start_, now)).count();
  if (seconds > 0) seconds = std::max(kLeast, seconds - spent);
}

/// None if it does not get dense, or the budget is used up. Where seeds that DelSurf would begin with are not near the
/// triangles, it is not dense: in they go.
std::optional<SurfaceTriangulation> DelSurfOnceDense::dense_sample() {
  constexpr int kMostLooks = 8;
  constexpr double kMostUncovered = 0.02;  // of seeds
  constexpr double kMostRough = 0.1;  // of triangles: a few rough places are Del S's, of many everything is
  make_whole();
  seeds_ = oracle_.seeds(criteria_.size, [this] { return whole_->budget().go_on_now(0, 0), true; }).points;
  const std::size_t seed_count = seeds_.size();
  whole_->leave_dense();
  whole_->start();
  if (whole_->rough_share() > kMostRough) return std::nullopt;
  for (int look = 0; look < kMostLooks; ++look) {
    refine_surface(*whole_);
    if (whole_->budget().exhausted()) return std::nullopt;
    auto surface = whole_->surface_triangulation();
    if (!surface) return std::nullopt;
    const std::vector<Point3> uncovered = take_uncovered_seeds(*surface);
    if (static_cast<double>(uncovered.size()) > kMostUncovered * static_cast<double>(seed_count)) return std::nullopt;
    if (uncovered.empty()) {
      whole_->report_unmet();
      whole_->budget().end_stage();
      return surface;
    }
    whole_->insert_more(uncovered);
  }
  return std::nullopt;
}

/// They become vertices, as in DelSurf all do; what is still to be covered are the others.
std::vector<Point3> DelSurfOnceDense::take_uncovered_seeds(const SurfaceTriangulation& surface) {
  std::vector<Point3> taken, left;
  const auto uncovered = surface.look_into_balls(seeds_, kDenseOffset).uncovered;
  auto next = uncovered.begin();
  for (std::uint32_t i = 0; i < seeds_.size(); ++i) {
    const bool is_next = next != uncovered.end() && *next == i;
    if (is_next) ++next;
    (is_next ? taken : left).push_back(seeds_[i]);
  }
  seeds_ = std::move(left);
  return taken;
}

/// Held to the seeds once more: where these are in balls, nothing of their size was missed.
void DelSurfOnceDense::refine_dense(SurfaceTriangulation& surface) {
  RunBudget budget(control_, report_);
  budget.begin_stage("dense");
  DenseRefinement dense(surface, oracle_, criteria_, budget);
  missed_ = dense.refine(seeds_, report_.dense_failures);
  budget.end_stage();
  dense.report_deviation(report_);
  report_.dense_insertions = dense.insertions();
  if (budget.exhausted()) report_.dense_failures = 0;  // what there is, is written
}

/// As if it had not been tried.
SurfaceMesh DelSurfOnceDense::run_plain() {
  begin_phase();
  const auto stages = report_.stages;
  report_ = RunReport{};
  report_.stages = stages;
  make_whole();
  whole_->start();
  return finish_whole();
}

SurfaceMesh DelSurfOnceDense::finish_from(std::vector<Point3> sample) {
  begin_phase();
  sample.insert(sample.end(), missed_.begin(), missed_.end());
  report_.unmet.clear();
  make_whole();
  whole_->start_with(std::exchange(sample, {}));
  return finish_whole();
}

void check_options(const DelSurfOptions& options) {
  const auto refuse = [](const char* what) {
    throw OptionError(std::string("surface-only-after-dense: not with ") + what);
  };
  if (options.variant.start != Start::kSeeds) refuse("persistent triangles");
  if (options.variant.restricted != Restricted::kBipolar) refuse("all restricted triangles");
  if (options.surface.max_roughness_degrees < 180) refuse("a bound on roughness");
  if (options.surface.feature_angle_degrees < 180) refuse("sharp edges that are to be kept");
}

}  // namespace

SurfaceMesh delsurf_once_dense(const Oracle& oracle, const DelSurfOptions& options, RunReport& report) {
  check_options(options);
  return DelSurfOnceDense(oracle, options, report).run();
}

}  // namespace delvox
