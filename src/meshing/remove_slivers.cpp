#include "delvox/meshing/remove_slivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "delvox/core/errors.h"
#include "meshing/check_options.h"
#include "meshing/local_repair.h"
#include "meshing/run_budget.h"
#include "meshing/trial_repair.h"
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
        mesh_(mesh),
        surface_(oracle, surface),
        local_(mesh_, tets, surface_),
        trial_(mesh_, tets, surface_, local_),
        budget_(budget) {}

  void run(std::vector<std::uint32_t> slivers, SliverReport& report);

 private:
  template <class Repair>
  std::vector<std::uint32_t> one_round(const std::vector<std::uint32_t>& slivers, const Repair& repair);

  const double min_dihedral_degrees_;
  RepairMesh mesh_;
  SurfaceLimits surface_;
  LocalRepair local_;
  TrialRepair trial_;
  RunBudget& budget_;
};

// Single changes while they help, then trials of what resists, then what takes the longest, for the few that are left.
void SliverRemoval::run(std::vector<std::uint32_t> slivers, SliverReport& report) {
  constexpr int kRounds = 3, kTrialRounds = 3, kShakingRounds = 8;
  const auto by_one_change = [&](std::uint32_t tet) { local_.repair(tet); };
  const auto by_trial = [&](std::uint32_t tet) {
    if (!(local_.repair(tet) > 0)) trial_.repair(tet);
  };
  constexpr int kLargestEffort = 200;
  int shaken = 0;
  const auto by_shaking = [&](std::uint32_t tet) {
    if (local_.repair(tet) > 0 || surface_forbids(mesh_, mesh_.tet(tet), min_dihedral_degrees_)) return;
    if (!trial_.repair(tet) && ++shaken <= kLargestEffort) trial_.shake(tet);
  };
  for (int round = 0; round < kRounds && !slivers.empty(); ++round) slivers = one_round(slivers, by_one_change);
  for (int round = 0; round < kTrialRounds && !slivers.empty(); ++round) slivers = one_round(slivers, by_trial);
  for (int round = 0; round < kShakingRounds && !slivers.empty(); ++round) slivers = one_round(slivers, by_shaking);
  report.reconnections = local_.reconnections();
  report.moves = local_.moves();
  report.insertions = trial_.insertions();
  report.removals = trial_.removals();
  report.unmet = unmet_tets(mesh_, slivers, min_dihedral_degrees_);
  if (budget_.exhausted()) {
    for (UnmetTet& unmet : report.unmet) unmet.reason = "the run was stopped before";
  }
  mesh_.finish();
}

// The slivers that are left, and those that came of repairing others, in the order of their numbers.
template <class Repair>
std::vector<std::uint32_t> SliverRemoval::one_round(const std::vector<std::uint32_t>& slivers, const Repair& repair) {
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < slivers.size(); ++i) {
    const std::uint32_t tet = slivers[i];
    if (!local_.is_sliver(tet)) continue;
    if (budget_.go_on(mesh_.point_count(), slivers.size() - i)) repair(tet);
    left.push_back(tet);
  }
  left.insert(left.end(), local_.waiting().begin(), local_.waiting().end());
  local_.waiting().clear();
  std::sort(left.begin(), left.end());
  left.erase(std::unique(left.begin(), left.end()), left.end());
  std::erase_if(left, [&](std::uint32_t t) { return !local_.is_sliver(t); });
  return left;
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
  if (!mesh.info.promises.max_roughness_degrees) surface.max_roughness_degrees = 180;
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
