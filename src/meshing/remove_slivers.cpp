#include "delvox/meshing/remove_slivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "delvox/core/errors.h"
#include "meshing/check_options.h"
#include "meshing/reconnection.h"
#include "meshing/run_budget.h"
#include "meshing/star_smoothing.h"
#include "meshing/unmet_tets.h"

namespace delvox {
namespace {

// Numbers of the tets that fall short, in their order.
std::vector<std::uint32_t> find_slivers(const TetMesh& mesh, const TetLimits& limits) {
  constexpr std::size_t kChunk = 8192;
  const auto& p = mesh.points;
  const auto parts = map_chunks(mesh.tets.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = mesh.tets[i];
      if (limits.shortfall(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) > 0) found.push_back(static_cast<std::uint32_t>(i));
    }
    return found;
  });
  std::vector<std::uint32_t> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

class SliverRemoval {
 public:
  /// `tets` are the limits with that bound on dihedral angles.
  SliverRemoval(TetMesh& mesh, const Oracle& oracle, const SurfaceCriteria& surface, const TetLimits& tets,
                double min_dihedral_degrees, RunBudget& budget)
      : min_dihedral_degrees_(min_dihedral_degrees),
        points_(mesh.points),
        mesh_(mesh),
        tets_(tets),
        surface_(oracle, surface),
        guard_(mesh_),
        reconnection_(mesh_, tets_, surface_, guard_),
        smoothing_(mesh_, tets_, surface_, guard_),
        budget_(budget) {}

  void run(std::vector<std::uint32_t> slivers, SliverReport& report);

 private:
  // Less than this share of a flat tet's shortfall is no gain: what goes on must come to an end.
  static constexpr double kLeastGain = 1e-4;
  static constexpr int kRounds = 6;

  double shortfall(std::uint32_t tet) const {
    const Tet& t = mesh_.tet(tet);
    return tets_.shortfall(mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2]), mesh_.point(t[3]));
  }
  bool is_sliver(std::uint32_t tet) const { return mesh_.alive(tet) && shortfall(tet) > 0; }
  bool reconnect(std::uint32_t tet);
  bool move_corners(std::uint32_t tet);
  void await(std::span<const std::uint32_t> tets) {
    std::copy_if(tets.begin(), tets.end(), std::back_inserter(waiting_), [&](std::uint32_t t) { return is_sliver(t); });
  }
  void end_round();

  const double min_dihedral_degrees_;
  const std::vector<Point3>& points_;
  RepairMesh mesh_;
  const TetLimits& tets_;
  SurfaceLimits surface_;
  CrossingGuard guard_;
  Reconnection reconnection_;
  StarSmoothing smoothing_;
  RunBudget& budget_;
  std::vector<std::uint32_t> waiting_;  // slivers that resisted, and those that came of repairing others
  std::size_t reconnections_ = 0, moves_ = 0;
  Change change_, best_change_;
};

void SliverRemoval::run(std::vector<std::uint32_t> slivers, SliverReport& report) {
  bool changed = true, go_on = true;
  for (int round = 0; round < kRounds && changed && go_on; ++round) {
    changed = false;
    for (std::size_t i = 0; i < slivers.size(); ++i) {
      go_on = go_on && budget_.go_on(points_.size(), slivers.size() - i);
      const std::uint32_t tet = slivers[i];
      if (!is_sliver(tet)) continue;
      if (go_on && (reconnect(tet) || move_corners(tet))) changed = true;
      if (is_sliver(tet)) waiting_.push_back(tet);
    }
    end_round();
    slivers.swap(waiting_);
  }
  report.reconnections = reconnections_;
  report.moves = moves_;
  report.unmet = unmet_tets(mesh_, slivers, min_dihedral_degrees_);
  if (!go_on) {
    for (UnmetTet& unmet : report.unmet) unmet.reason = "the run was stopped before";
  }
  mesh_.finish();
}

void SliverRemoval::end_round() {
  std::sort(waiting_.begin(), waiting_.end());
  waiting_.erase(std::unique(waiting_.begin(), waiting_.end()), waiting_.end());
  std::erase_if(waiting_, [&](std::uint32_t t) { return !is_sliver(t); });
}

// Makes the best of the changes at the edges and faces of a tet.
bool SliverRemoval::reconnect(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  double best = kLeastGain;
  const auto take = [&](double gain) {
    if (!(gain > best)) return;
    best = gain;
    std::swap(best_change_, change_);
  };
  best_change_.clear();
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) take(reconnection_.remove_edge(corners[i], corners[j], change_));
  }
  for (int i = 0; i < 4; ++i) take(reconnection_.remove_faces(tet, i, change_));
  if (best_change_.old_tets.empty()) return false;
  mesh_.apply(best_change_);
  guard_.changed(mesh_.added_triangles());
  ++reconnections_;
  await(mesh_.added_tets());
  return true;
}

bool SliverRemoval::move_corners(std::uint32_t tet) {
  const Tet corners = mesh_.tet(tet);
  bool moved = false;
  for (std::uint32_t v : corners) {
    Point3 place;
    if (!(smoothing_.improve(v, place) > kLeastGain)) continue;
    mesh_.move(v, place);
    guard_.changed(mesh_.fan(v));
    ++moves_;
    moved = true;
    await(mesh_.star(v));
    if (!is_sliver(tet)) break;
  }
  return moved;
}

// One entry for each reason.
void tell(const std::vector<UnmetTet>& unmet, RunReport& report) {
  for (const UnmetTet& tet : unmet) {
    const auto known = std::find_if(report.unmet.begin(), report.unmet.end(), [&](const Unmet& entry) {
      return entry.criterion == kDihedral && entry.reason == tet.reason;
    });
    if (known != report.unmet.end()) {
      ++known->count;
    } else {
      report.unmet.push_back({kDihedral, 1, tet.where, tet.reason, false});
    }
  }
}

}  // namespace

SliverReport remove_slivers(TetMesh& mesh, const Oracle& oracle, const RemoveSliversOptions& options,
                            RunReport& report) {
  check_criteria(options.surface);
  check_criteria(options.tets);
  if (!(options.min_dihedral_degrees > 0 && options.min_dihedral_degrees <= 30)) {
    throw OptionError("min-dihedral " + std::to_string(options.min_dihedral_degrees) +
                      ": slivers are removed for bounds above 0 and up to 30 degrees; choose a value in that range");
  }
  if (!mesh.mid_nodes.empty() || !mesh.sets.empty()) {
    throw OptionError("slivers are removed from meshes of first order without sets; make these afterwards");
  }
  RunControl control = options.control;
  control.limits.max_vertices = 0;
  RunBudget budget(control, report);
  budget.begin_stage("slivers");
  SurfaceCriteria surface = options.surface;
  if (!mesh.info.promises.max_deviation) surface.max_deviation = std::numeric_limits<double>::infinity();
  if (mesh.boundary.empty()) mesh.boundary = boundary_of(mesh.tets);
  const TetLimits limits(options.min_dihedral_degrees, options.tets);
  SliverReport result;
  std::vector<std::uint32_t> slivers = find_slivers(mesh, limits);
  result.slivers = slivers.size();
  if (!slivers.empty()) {
    SliverRemoval removal(mesh, oracle, surface, limits, options.min_dihedral_degrees, budget);
    removal.run(std::move(slivers), result);
  }
  budget.end_stage();
  tell(result.unmet, report);
  if (result.unmet.empty()) mesh.info.promises.min_dihedral_degrees = options.min_dihedral_degrees;
  return result;
}

}  // namespace delvox
